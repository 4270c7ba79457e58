/**
 * Collisions between two keyframes, as far as these tell: those of spheres that had one impulse.
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {{t: number, i: number, j: number, impulse: Vec3}} Collision j < 0: wall −1 − j
 */
import { crossing, momentOf, nearestImage } from "./interpolation.js";
import { dot, length, scale, sub } from "./matrix.js";
import { STILL } from "./wire.js";

const TOGETHER = 0.02; // of the time between keyframes: two crossings may be that far apart
const TOUCHING = 0.03; // of the sum of radii: by how much the two may miss one another

/**
 * In order of time; between spheres, or with walls where spheres meet no others.
 * @param {Keyframe} first @param {Keyframe} second @param {import("./protocol.js").Scene} scene
 * @returns {Collision[]}
 */
export function collisionsBetween(first, second, scene) {
  const h = second.t - first.t;
  const { about, radius, mass, n } = scene;
  const period = /** @type {Vec3} */ (about.period);
  /** @type {{i: number, s: number, x: Vec3, kick: Vec3}[]} */ const hits = [];
  for (let i = 0; i < n; i++) {
    if (first.counts[i] === second.counts[i]) continue;
    const [a, b] = [momentOf(first, i), momentOf(second, i)];
    const corner = crossing(a, b, h, second.gravity, period);
    const fall = first.counts[i] & STILL ? /** @type {Vec3} */ ([0, 0, 0]) : scale(second.gravity, h);
    if (corner !== null) hits.push({ i, ...corner, kick: sub(sub(b.v, a.v), fall) });
  }
  hits.sort((a, b) => a.s - b.s);
  /** @type {Collision[]} */ const found = [];
  const taken = new Set();
  hits.forEach(({ i, s, x, kick }, place) => {
    if (taken.has(i)) return;
    let [partner, least] = [-1, TOUCHING];
    for (let other = place + 1; other < hits.length && hits[other].s - s <= TOGETHER * h; other++) {
      const { i: j, x: y, kick: back } = hits[other];
      if (taken.has(j) || dot(kick, back) >= 0) continue;
      const reach = radius[i] + radius[j];
      const miss = Math.abs(length(sub(x, nearestImage(y, x, period))) - reach) / reach;
      if (miss < least) [partner, least] = [j, miss];
    }
    const t = first.t + s;
    const impulse = scale(kick, Number.isFinite(mass[i]) ? mass[i] : 1);
    if (partner >= 0) {
      taken.add(partner);
      found.push({ t, i, j: partner, impulse });
    } else if (!about.collide || n === 1) {
      const facing = about.walls.map(({ normal }) => dot(/** @type {Vec3} */ (normal), kick));
      const wall = Math.max(0, facing.indexOf(Math.max(...facing)));
      found.push({ t, i, j: -1 - wall, impulse });
    }
  });
  return found;
}
