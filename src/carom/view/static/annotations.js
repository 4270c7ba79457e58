/**
 * What the hands lay over the picture: rings, arrows, trails, and a ball that is not there yet.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {Pick<import("./renderer.js").Picture, "marks" | "arrows" | "trails" | "ghost">} Annotations
 */
import { arrowEnds } from "./arrows.js";
import { unpack } from "./colors.js";
import { length, sub } from "./matrix.js";
import { everywhere } from "./pick.js";

const COLORS = {
  dark: { selected: 0xffc94d, velocity: 0xffe3a1, impulse: 0xff6f61 },
  light: { selected: 0xd97a00, velocity: 0xa85800, impulse: 0xd02a1c },
};

/** @param {import("./tools.js").Hands} hands @returns {Annotations} */
export function annotate(hands) {
  const { scene, sides, theme } = hands;
  /** @type {Annotations} */
  const overlay = { marks: [], arrows: [], trails: [], ghost: null };
  if (scene === null || sides.length === 0) return overlay;
  selection(hands, scene, overlay);
  const flash = hands.flash.parts(sides[0], scene, unpack(COLORS[theme].impulse));
  overlay.marks.push(...flash.marks);
  overlay.arrows.push(...flash.arrows);
  const { next } = hands;
  if (next.ghost !== null) {
    const { position: x, velocity } = next.ghost;
    overlay.ghost = { side: 0, x, radius: next.radius, color: next.rgb };
    arrow(overlay, arrowEnds(x, next.radius, velocity, hands.time), unpack(COLORS[theme].velocity));
  }
  return overlay;
}

/**
 * @param {import("./tools.js").Hands} hands
 * @param {import("./protocol.js").Scene} scene
 * @param {Annotations} overlay
 */
function selection(hands, scene, overlay) {
  const { selected, sides, theme } = hands;
  if (selected === null || selected >= scene.n) return;
  const color = unpack(COLORS[theme].selected);
  sides.forEach((_, side) => {
    const sphere = hands.stateOf(selected, side);
    if (sphere === null) return;
    const radius = scene.radius[selected];
    for (const x of everywhere(sphere.x, radius, /** @type {Vec3} */ (scene.about.period))) {
      overlay.marks.push({ side, x, radius, color, strength: 1 });
    }
    if (hands.trailing && hands.trails[side]) {
      overlay.trails.push({ side, points: hands.trails[side].points, color });
    }
  });
  const { handle } = hands;
  if (handle.ball !== null) arrow(overlay, handle.arrow, unpack(COLORS[theme].velocity));
}

/** @param {Annotations} overlay @param {{from: Vec3, to: Vec3}} ends @param {import("./colors.js").Rgb} color */
function arrow(overlay, { from, to }, color) {
  if (length(sub(to, from)) === 0) return;
  overlay.arrows.push({ side: 0, from, to, color, strength: 1 });
}
