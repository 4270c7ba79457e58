/**
 * Which sphere is seen under a pixel.
 *
 * All spheres are asked, in one pass without memory: could the place where this one is drawn
 * lie near the line of sight at all? The few that could are then put where they are drawn.
 *
 * @typedef {import("./camera.js").Ray} Ray
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./matrix.js").Vec3} Vec3
 */
import { placeOf } from "./interpolation.js";
import { dot, length, sub } from "./matrix.js";

/**
 * The nearest sphere on a line of sight, or, if there is none, the one that it misses least.
 * @param {Keyframe} first @param {Keyframe} second @param {number} t between the two
 * @param {ArrayLike<number>} radius
 * @param {Vec3} period
 * @param {Ray} ray
 * @param {number} slack how far it may miss one, per unit of distance
 * @returns {number | null}
 */
export function pick(first, second, t, radius, period, ray, slack) {
  let best = null;
  let nearest = Infinity; // distance of what is hit
  let least = slack; // of what is missed
  for (const i of candidates(first, second, t, radius, period, ray, slack)) {
    const r = radius[i];
    for (const x of everywhere(placeOf(first, second, t, i, period).x, r, period)) {
      const line = sub(x, ray.origin);
      const along = dot(line, ray.direction);
      if (along <= 0) continue;
      const across2 = dot(line, line) - along * along;
      if (across2 <= r * r) {
        const entry = along - Math.sqrt(r * r - across2);
        if (entry >= nearest) continue;
        nearest = entry;
        best = i;
      } else if (nearest === Infinity) {
        const miss = (Math.sqrt(across2) - r) / along;
        if (miss > least) continue;
        least = miss;
        best = i;
      }
    }
  }
  return best;
}

/**
 * Where a sphere is seen: a sphere that reaches over a periodic border, on both sides of it.
 * @param {Vec3} x @param {number} radius @param {Vec3} period
 * @returns {Vec3[]} its place first
 */
export function everywhere(x, radius, period) {
  let places = [x];
  for (let k = 0; k < 3; k++) {
    if (!(period[k] > 0) || Math.abs(x[k]) + radius <= 0.5 * period[k]) continue;
    const beyond = places.map((place) => {
      const image = /** @type {Vec3} */ ([...place]);
      image[k] -= Math.sign(x[k]) * period[k];
      return image;
    });
    places = [...places, ...beyond];
  }
  return places;
}

/**
 * Spheres that may be on the line: it passes their first place no farther away than they can
 * have moved. On its way a sphere stays within |x₁ − x₀| + (|v₀| + |v₁| + |g| h) h of x₀.
 * @param {Keyframe} first @param {Keyframe} second @param {number} t
 * @param {ArrayLike<number>} radius @param {Vec3} period @param {Ray} ray @param {number} slack
 */
function candidates(first, second, t, radius, period, ray, slack) {
  const arrived = t >= second.t; // then the second place is where it is drawn
  const { position: a, velocity: v } = arrived ? second : first;
  const { position: b, velocity: w } = second;
  const h = arrived ? 0 : second.t - first.t;
  const fall = length(second.gravity) * h;
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  const [px, py, pz] = period;
  const found = [];
  for (let i = 0, k = 0; i < second.n; i++, k += 3) {
    const x = a[k] - ox;
    const y = a[k + 1] - oy;
    const z = a[k + 2] - oz;
    let reach = 0;
    if (h > 0) {
      const mx = b[k] - a[k];
      const my = b[k + 1] - a[k + 1];
      const mz = b[k + 2] - a[k + 2];
      const far = Math.sqrt(mx * mx + my * my + mz * mz);
      const v0 = Math.sqrt(v[k] * v[k] + v[k + 1] * v[k + 1] + v[k + 2] * v[k + 2]);
      const v1 = Math.sqrt(w[k] * w[k] + w[k + 1] * w[k + 1] + w[k + 2] * w[k + 2]);
      reach = far + (v0 + v1 + fall) * h;
    }
    reach += radius[i];
    // Near a periodic border it may be drawn on the other side.
    if (
      (px > 0 && Math.abs(a[k]) + reach > 0.5 * px) ||
      (py > 0 && Math.abs(a[k + 1]) + reach > 0.5 * py) ||
      (pz > 0 && Math.abs(a[k + 2]) + reach > 0.5 * pz)
    ) {
      found.push(i);
      continue;
    }
    const along = x * dx + y * dy + z * dz;
    const most = reach + slack * Math.abs(along + reach);
    if (x * x + y * y + z * z - along * along <= most * most) found.push(i);
  }
  return found;
}
