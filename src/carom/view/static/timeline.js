/**
 * Which moment to draw now: keyframes as they came, and a clock that runs about one of them
 * behind, so that every picture lies between two known keyframes and nothing is ever guessed.
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 */

const KEPT = 12;
export const BREAK = 0.5; // seconds without a keyframe, after which motion jumps instead of sliding
const DELAY = 1.25; // keyframes; one to stand between two, the rest for late ones
const PULL = 6; // per second: how firmly the clock is drawn to its place

export class Timeline {
  constructor() {
    /** @type {Keyframe[]} */ this.keyframes = [];
    this.t = 0;
    this.rate = 0; // simulated time per second
    this.age = 0; // seconds since the newest keyframe came
    this.interval = 0; // seconds between keyframes
  }

  /** The newest keyframe. */
  get newest() {
    return this.keyframes.at(-1);
  }

  clear() {
    this.keyframes = [];
  }

  /** @param {Keyframe} keyframe */
  push(keyframe) {
    const last = this.newest;
    const jump =
      last === undefined ||
      keyframe.epoch !== last.epoch ||
      keyframe.scene !== last.scene ||
      keyframe.t < last.t ||
      keyframe.clock - last.clock > BREAK;
    if (jump) {
      this.keyframes = [];
      this.t = keyframe.t;
      this.rate = 0;
    }
    this.keyframes.push(keyframe);
    if (this.keyframes.length > KEPT) this.keyframes.shift();
    this.age = 0;
    const oldest = this.keyframes[0];
    const seconds = keyframe.clock - oldest.clock;
    if (keyframe.playing && seconds > 0) {
      this.rate = (keyframe.t - oldest.t) / seconds;
      this.interval = seconds / (this.keyframes.length - 1);
    }
  }

  /**
   * Let the clock run, and say between which keyframes it stands.
   * @param {number} seconds since the last call
   * @returns {[Keyframe, Keyframe] | null}
   */
  advance(seconds) {
    const { keyframes } = this;
    const newest = keyframes.at(-1);
    if (newest === undefined) return null;
    this.age += seconds;
    const before = this.t;
    if (this.rate === 0) this.t = newest.t;
    else if (newest.playing) {
      const place = newest.t + this.rate * (this.age - DELAY * this.interval);
      this.t += this.rate * seconds;
      this.t += (place - this.t) * Math.min(1, PULL * seconds);
    } else this.t += Math.max(this.rate * seconds, 0.1 * (newest.t - this.t));
    if (newest.t - this.t < 1e-3 * this.rate * this.interval) this.t = newest.t;
    // A keyframe that came late draws the clock back: then it stands a while, and never goes back.
    this.t = Math.min(newest.t, Math.max(keyframes[0].t, before, this.t));
    let k = keyframes.length - 1;
    while (k > 0 && keyframes[k - 1].t > this.t) k--;
    return [keyframes[Math.max(k - 1, 0)], keyframes[k]];
  }
}
