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
const SPEED_SCALE = [0x4059d6, 0x4c8fe6, 0x55bccb, 0xb4d98a, 0xffe65a].map(unpack);

/**
 * From few collisions to many: through purple and orange, for the same reasons, and never to be
 * taken for speeds.
 */
const COLLISION_SCALE = [0x5b2a86, 0x9c2f7f, 0xdb4f5f, 0xf98e4b, 0xfde7a0].map(unpack);

/** The scales of the colour modes that have one. */
export const SCALES = { speed: SPEED_SCALE, collisions: COLLISION_SCALE };

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

/**
 * The dark and the light page. back: behind everything; line, shell: flat and round walls;
 * surface, floor, wall: a wall's colour and how opaque it is; key, sky, ground: amounts of light;
 * tint: added to wires; arrow: velocities; shade, contact: darkness of shadows and of spots under spheres; fog: its
 * thickness at the far end.
 */
export const THEMES = {
  dark: {
    back: unpack(0x1a2231),
    line: unpack(0xa9bad6),
    shell: unpack(0x35d97c),
    surface: unpack(0x3d4a63),
    floor: 0.72,
    wall: 0.16,
    key: /** @type {Rgb} */ ([1.2, 1.16, 1.1]),
    sky: /** @type {Rgb} */ ([0.34, 0.38, 0.46]),
    ground: /** @type {Rgb} */ ([0.09, 0.095, 0.12]),
    tint: /** @type {Rgb} */ ([0.06, 0.06, 0.06]),
    arrow: unpack(0xf4f1e6),
    shade: 0.6,
    contact: 0.75,
    fog: 0.5,
  },
  light: {
    back: unpack(0xfafbfd),
    line: unpack(0x40506b),
    shell: unpack(0x0d9a4a),
    surface: unpack(0xe4e8ef),
    floor: 0.85,
    wall: 0.3,
    key: /** @type {Rgb} */ ([0.95, 0.93, 0.9]),
    sky: /** @type {Rgb} */ ([0.5, 0.52, 0.56]),
    ground: /** @type {Rgb} */ ([0.24, 0.24, 0.25]),
    tint: /** @type {Rgb} */ ([-0.46, -0.46, -0.46]),
    arrow: unpack(0x3b4252),
    shade: 0.26,
    contact: 0.42,
    fog: 0.5,
  },
};
