/**
 * Exact motion between two keyframes: the vertex shader's formulas (`glsl.js`, MOTION) once
 * more in double precision, for tests and for whatever needs a place without drawing it.
 *
 * Between t₀ and t₁ = t₀ + h the path forward from (x₀, v₀) and the path backward from (x₁, v₁)
 * are both known. Without an impulse they are one path. With exactly one they cross at it: with
 * w₁ = v₁ − g h, d = x₁ − ½ g h² − x₀ − w₁ h, the crossing is at d·(v₀ − w₁)/|v₀ − w₁|². With
 * more, places are mixed in a straight line, which never leaves a convex world.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {object} Moment one sphere in one keyframe
 * @property {Vec3} x
 * @property {Vec3} v
 * @property {number} count impulses so far in 31 bits; the top bit: no gravity
 */
import { add, dot, scale, sub } from "./matrix.js";
import { STILL } from "./wire.js";

/**
 * Shift x by whole boxes to the image nearest to a place.
 * @param {Vec3} x @param {Vec3} place @param {Vec3} period 0 on axes that are not periodic
 */
export function nearestImage(x, place, period) {
  return /** @type {Vec3} */ (
    x.map((value, k) =>
      period[k] > 0 ? value + period[k] * Math.round((place[k] - value) / period[k]) : value,
    )
  );
}

/** @param {Vec3} x @param {Vec3} period */
export function wrap(x, period) {
  return /** @type {Vec3} */ (
    x.map((value, k) =>
      period[k] > 0 ? value - period[k] * Math.floor(value / period[k] + 0.5) : value,
    )
  );
}

/** @param {Vec3} a @param {Vec3} b @param {number} s @returns {Vec3} */
const mix = (a, b, s) => add(scale(a, 1 - s), scale(b, s));

/**
 * Place, velocity and squared speed at s ∈ [0, h] after the first of two keyframes. Where nothing
 * better is known energies are mixed, not velocities, so v2 is not always the square of v.
 * @param {Moment} a @param {Moment} b
 * @param {number} s @param {number} h
 * @param {Vec3} gravity @param {Vec3} period
 * @returns {{x: Vec3, v: Vec3, v2: number}}
 */
export function motion(a, b, s, h, gravity, period) {
  if (!(h > 0)) return { x: b.x, v: b.v, v2: dot(b.v, b.v) };
  const hits = (b.count - a.count) & 0x7fffffff;
  if (hits > 1 || (a.count & STILL) !== (b.count & STILL)) return blend(a, b, s, h, period);
  const g = a.count & STILL ? /** @type {Vec3} */ ([0, 0, 0]) : gravity;
  const forward = add(a.x, add(scale(a.v, s), scale(g, 0.5 * s * s)));
  const ahead = add(a.v, scale(g, s));
  const behind = sub(b.v, scale(g, h - s));
  const backward = (/** @type {Vec3} */ x1) =>
    add(x1, sub(scale(g, 0.5 * (h - s) ** 2), scale(b.v, h - s)));
  if (hits === 0) {
    const x1 = nearestImage(b.x, add(a.x, add(scale(a.v, h), scale(g, 0.5 * h * h))), period);
    const x = wrap(mix(forward, backward(x1), s / h), period);
    return { x, v: mix(ahead, behind, s / h), v2: mixed(ahead, behind, s / h) };
  }
  const { s: when, x1 } = meeting(a, b, h, g, period);
  return s < when
    ? { x: wrap(forward, period), v: ahead, v2: dot(ahead, ahead) }
    : { x: wrap(backward(x1), period), v: behind, v2: dot(behind, behind) };
}

/**
 * When and where the paths forward and backward cross, and the image of the second place there.
 * @param {Moment} a @param {Moment} b @param {number} h @param {Vec3} g @param {Vec3} period
 */
function meeting(a, b, h, g, period) {
  const w1 = sub(b.v, scale(g, h));
  const fall = scale(g, 0.5 * h * h);
  const kick = sub(a.v, w1);
  const strength = dot(kick, kick);
  let s = 0.5 * h;
  let x1 = b.x;
  // The image depends on the crossing and the crossing on the image: the second round settles it.
  for (let round = 0; round < 2; round++) {
    const end = add(add(scale(a.v, s), scale(w1, h - s)), fall);
    x1 = nearestImage(b.x, add(a.x, end), period);
    const d = sub(sub(x1, fall), add(a.x, scale(w1, h)));
    if (strength > 0) s = Math.min(h, Math.max(0, dot(d, kick) / strength));
  }
  return { s, x: wrap(add(a.x, add(scale(a.v, s), scale(g, 0.5 * s * s))), period), x1 };
}

/**
 * The corner of a path between two keyframes: null unless there was exactly one impulse.
 * @param {Moment} a @param {Moment} b @param {number} h @param {Vec3} gravity @param {Vec3} period
 * @returns {{s: number, x: Vec3} | null} s after the first keyframe
 */
export function crossing(a, b, h, gravity, period) {
  const single = ((b.count - a.count) & 0x7fffffff) === 1 && (a.count & STILL) === (b.count & STILL);
  if (!single || !(h > 0)) return null;
  const { s, x } = meeting(a, b, h, a.count & STILL ? [0, 0, 0] : gravity, period);
  return { s, x };
}

/** @param {import("./protocol.js").Keyframe} frame @param {number} i @returns {Moment} */
export const momentOf = ({ position: x, velocity: v, counts }, i) => ({
  x: [x[3 * i], x[3 * i + 1], x[3 * i + 2]],
  v: [v[3 * i], v[3 * i + 1], v[3 * i + 2]],
  count: counts[i],
});

/**
 * Sphere i at the moment t between two keyframes.
 * @param {import("./protocol.js").Keyframe} first @param {import("./protocol.js").Keyframe} second
 * @param {number} t @param {number} i @param {Vec3} period
 */
export function placeOf(first, second, t, i, period) {
  const h = second.t - first.t;
  const s = Math.min(Math.max(t - first.t, 0), h);
  return motion(momentOf(first, i), momentOf(second, i), s, h, second.gravity, period);
}

/** @param {Vec3} v @param {Vec3} w @param {number} s energies are mixed, not velocities */
const mixed = (v, w, s) => (1 - s) * dot(v, v) + s * dot(w, w);

/**
 * @param {Moment} a @param {Moment} b @param {number} s @param {number} h @param {Vec3} period
 */
function blend(a, b, s, h, period) {
  const end = add(a.x, scale(add(a.v, b.v), 0.5 * h));
  const x1 = nearestImage(b.x, end, period);
  return { x: wrap(mix(a.x, x1, s / h), period), v: mix(a.v, b.v, s / h), v2: mixed(a.v, b.v, s / h) };
}
