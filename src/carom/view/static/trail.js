/**
 * The way a sphere has come: its places as they were drawn, and the exact corner between two of
 * them where it collided once.
 *
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./matrix.js").Vec3} Vec3
 */
import { crossing, momentOf, placeOf } from "./interpolation.js";
import { BREAK } from "./timeline.js";

const LENGTH = 600; // points: ten seconds at sixty pictures a second

export class Trail {
  /** @param {number} [limit] points that are kept */
  constructor(limit = LENGTH) {
    this.limit = limit;
    // Twice as long as it looks: it is moved to the front only once in `limit` points.
    this.memory = new Float32Array(6 * limit);
    this.count = 0; // points in memory
    /** The newest point. @type {Vec3 | null} */ this.last = null;
    /** What was drawn before. @type {{first: Keyframe, second: Keyframe, t: number} | null} */
    this.before = null;
  }

  /** x, y, z of each point, the oldest first; three NaN where the line is interrupted. */
  get points() {
    return this.memory.subarray(3 * Math.max(0, this.count - this.limit), 3 * this.count);
  }

  /**
   * The sphere is drawn now, at the moment `t` between two keyframes.
   * @param {Keyframe} first @param {Keyframe} second @param {number} t
   * @param {number} i @param {Vec3} period
   */
  extend(first, second, t, i, period) {
    const { before } = this;
    // After a break nobody knows the way between.
    const jump =
      before !== null &&
      (before.second.epoch !== second.epoch || t < before.t || first.clock - before.second.clock > BREAK);
    if (before !== null && !jump && t === before.t) {
      this.before = { first, second, t };
      return;
    }
    if (jump) this.#interrupt();
    else if (before !== null) {
      // Corners before the picture that came before were drawn with that one.
      if (before.second === first) this.#corner(before.first, first, before.t, first.t, i, period);
      const since = before.second === second ? before.t : first.t;
      this.#corner(first, second, Math.max(since, before.t), t, i, period);
    }
    this.#append(placeOf(first, second, t, i, period).x, period);
    this.before = { first, second, t };
  }

  /**
   * The corner between two keyframes, if it lies after `from` and not after `to`.
   * @param {Keyframe} first @param {Keyframe} second @param {number} from @param {number} to
   * @param {number} i @param {Vec3} period
   */
  #corner(first, second, from, to, i, period) {
    const [a, b] = [momentOf(first, i), momentOf(second, i)];
    const corner = crossing(a, b, second.t - first.t, second.gravity, period);
    if (corner === null) return;
    const t = first.t + corner.s;
    if (t > from && t <= to) this.#append(corner.x, period);
  }

  /** @param {Vec3} place @param {Vec3} period */
  #append(place, period) {
    const { last } = this;
    // On a periodic axis nothing goes half a period between two pictures: it crossed the border.
    const far = (/** @type {number} */ k) =>
      last !== null && period[k] > 0 && Math.abs(place[k] - last[k]) > 0.5 * period[k];
    if (far(0) || far(1) || far(2)) this.#interrupt();
    this.#push(place);
    this.last = place;
  }

  #interrupt() {
    if (this.last !== null) this.#push([NaN, NaN, NaN]);
    this.last = null;
  }

  /** @param {Vec3} point */
  #push(point) {
    if (this.count === 2 * this.limit) {
      this.memory.copyWithin(0, 3 * this.limit);
      this.count = this.limit;
    }
    this.memory.set(point, 3 * this.count);
    this.count++;
  }
}
