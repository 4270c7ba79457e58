/** Colours of spheres, for the shaders and the legend; parts are numbers from 0 to 1. */

/** @typedef {[number, number, number]} Rgb */

/** @param {number} packed 0xRRGGBB @returns {Rgb} */
export const unpack = (packed) => [
  ((packed >> 16) & 255) / 255,
  ((packed >> 8) & 255) / 255,
  (packed & 255) / 255,
];

/**
 * From slow to fast: along blue and yellow, which nearly everybody can tell apart, and always
 * lighter, so that it reads in grey too.
 */
export const SPEED_SCALE = [0x4059d6, 0x4c8fe6, 0x55bccb, 0xb4d98a, 0xffe65a].map(unpack);

/** One per species, as `carom.color.SPECIES`: M. Okabe and K. Ito's colour-blind-safe set. */
export const SPECIES = [0x4c9be8, 0xe69f00, 0x009e73, 0xd55e00, 0xcc79a7, 0xf0e442, 0x0072b2].map(
  unpack,
);

/**
 * The paper's HSB colour: hue and brightness are the sphere's own, saturation is its energy.
 * @param {Rgb} own @param {number} saturation 0 … 1
 * @returns {Rgb}
 */
export function saturated(own, saturation) {
  const most = Math.max(...own);
  const least = Math.min(...own);
  const hue = most > least ? own.map((part) => (part - least) / (most - least)) : [1, 0, 0];
  return /** @type {Rgb} */ (hue.map((part) => most * (1 + saturation * (part - 1))));
}

/** @param {Rgb} rgb */
export const css = (rgb) => `rgb(${rgb.map((part) => Math.round(255 * part)).join(" ")})`;

/** Background, lines and light of the dark and the light page. */
export const THEMES = {
  dark: {
    back: unpack(0x1a2231),
    line: unpack(0xa9bad6),
    shell: unpack(0x35d97c),
    sky: /** @type {Rgb} */ ([0.3, 0.33, 0.39]),
    ground: /** @type {Rgb} */ ([0.07, 0.075, 0.1]),
    tint: /** @type {Rgb} */ ([0.06, 0.06, 0.06]),
  },
  light: {
    back: unpack(0xfafbfd),
    line: unpack(0x40506b),
    shell: unpack(0x0d9a4a),
    sky: /** @type {Rgb} */ ([0.46, 0.48, 0.52]),
    ground: /** @type {Rgb} */ ([0.2, 0.2, 0.22]),
    tint: /** @type {Rgb} */ ([-0.35, -0.35, -0.35]),
  },
};
