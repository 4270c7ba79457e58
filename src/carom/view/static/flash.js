/**
 * The collision that a step has led to: a ring around both balls, and an arrow along the impulse.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./tools.js").Side} Side
 * @typedef {import("./renderer.js").ArrowMark} ArrowMark
 * @typedef {import("./renderer.js").Mark} Mark
 * @typedef {{t: number, i: number, j: number, impulse: number[]}} Event j < 0: wall −1 − j
 */
import { nearestImage, placeOf } from "./interpolation.js";
import { add, normalize, scale, sub } from "./matrix.js";

const FADE = 1500; // milliseconds, once time goes on
const SETTLE = 600; // milliseconds in which a flash shrinks to a third while time stands
const GLOW = 0.4; // what is left of it then
const STEADY = 0.7; // instead of both, for people whom motion disturbs
const LONG = 3.4; // radii: the ball that is pushed hides two of them
const RIPPLE = 700; // milliseconds in which a second ring runs outwards
const WIDE = 1.1; // radii that it runs
const LOST = 3000; // milliseconds without the event's moment: it will not come
const SPHERE_WALL = 1;
const CYLINDER_WALL = 2;

/**
 * Where sphere i was touched.
 * @param {Event} event @param {Scene} scene @param {Vec3} x of sphere i @param {Vec3 | null} other of sphere j
 * @returns {Vec3}
 */
export function contact({ i, j }, scene, x, other) {
  const period = /** @type {Vec3} */ (scene.about.period);
  /** @type {Vec3} */ let out = [0, 0, 1]; // from the contact to the centre
  if (other !== null) out = sub(x, nearestImage(other, x, period));
  else {
    const wall = scene.about.walls[-1 - j];
    if (wall?.kind === SPHERE_WALL) out = scale(x, -1);
    else if (wall?.kind === CYLINDER_WALL) out = [-x[0], -x[1], 0];
    else if (wall !== undefined) out = /** @type {Vec3} */ (wall.normal);
  }
  return sub(x, scale(normalize(out), scene.radius[i]));
}

export class Flash {
  constructor() {
    this.calm = false;
    this.strength = 0;
    /** @type {Event | null} */ this.event = null;
    /** @type {{from: Vec3, to: Vec3} | null} */ this.arrow = null;
    this.since = 0; // milliseconds: when it was told, then when it was first seen
    this.left = NaN; // when time went on
    this.now = 0;
    this.epoch = -1;
  }

  /** @param {Event} event @param {number} now milliseconds */
  show(event, now) {
    this.clear();
    this.event = event;
    this.since = now;
  }

  clear() {
    this.event = this.arrow = null;
    this.strength = 0;
    this.left = NaN;
  }

  /**
   * True if it looks different now.
   * @param {Side} side @param {Scene} scene @param {number} now milliseconds
   */
  update({ first, second, t }, scene, now) {
    const { event } = this;
    if (event === null) return false;
    const before = this.strength;
    this.now = now;
    if (Math.max(event.i, event.j) >= scene.n) this.clear();
    else if (this.arrow === null) {
      if (t < event.t - 1e-9 * Math.max(1, Math.abs(event.t))) {
        if (now - this.since > LOST) this.clear();
        return false;
      }
      this.#start(event, first, second, t, scene, now);
    } else if (second.epoch !== this.epoch) this.clear();
    else if (second.playing && Number.isNaN(this.left)) this.left = now;
    if (this.event !== null) this.strength = this.#glow;
    if (this.strength === 0) this.clear();
    return this.strength !== before || this.#ripple < 1;
  }

  /** How far the second ring has run, from 0 to 1. */
  get #ripple() {
    return this.calm || this.arrow === null ? 1 : Math.min(1, (this.now - this.since) / RIPPLE);
  }

  /** How much of the flash is left since time went on. */
  get #rest() {
    return Number.isNaN(this.left) ? 1 : Math.max(0, 1 - (this.now - this.left) / FADE);
  }

  /**
   * @param {Event} event
   * @param {import("./protocol.js").Keyframe} first @param {import("./protocol.js").Keyframe} second
   * @param {number} t @param {Scene} scene @param {number} now
   */
  #start(event, first, second, t, scene, now) {
    const period = /** @type {Vec3} */ (scene.about.period);
    const { x } = placeOf(first, second, t, event.i, period);
    const other = event.j < 0 ? null : placeOf(first, second, t, event.j, period).x;
    const from = contact(event, scene, x, other);
    const along = normalize(/** @type {Vec3} */ (event.impulse));
    this.arrow = { from, to: add(from, scale(along, LONG * scene.radius[event.i])) };
    this.since = now;
    this.epoch = second.epoch;
  }

  get #glow() {
    if (this.calm) return this.#rest > 0 ? STEADY : 0;
    const settled = GLOW + (1 - GLOW) * Math.exp(-(this.now - this.since) / SETTLE);
    // Below a hundredth nothing changes to the eye: then pictures need not be drawn again.
    return Math.round(100 * settled * this.#rest) / 100;
  }

  /**
   * @param {Side} side @param {Scene} scene
   * @param {[number, number, number]} color
   * @returns {{marks: Mark[], arrows: ArrowMark[]}}
   */
  parts({ first, second, t }, scene, color) {
    const { event, strength } = this;
    if (event === null || this.arrow === null) return { marks: [], arrows: [] };
    const period = /** @type {Vec3} */ (scene.about.period);
    const ripple = this.#ripple;
    /** @type {Mark[]} */ const marks = [];
    for (const k of event.j < 0 ? [event.i] : [event.i, event.j]) {
      const { x } = placeOf(first, second, t, k, period);
      const radius = scene.radius[k];
      marks.push({ side: 0, x, radius, color, strength });
      if (ripple === 1) continue;
      const wide = radius * (1 + WIDE * ripple);
      marks.push({ side: 0, x, radius: wide, color, strength: (1 - ripple) ** 2 });
    }
    if (event.impulse.every((part) => part === 0)) return { marks, arrows: [] };
    // It stays clear as long as time stands, and then fades away.
    return { marks, arrows: [{ side: 0, ...this.arrow, color, strength: this.calm ? 1 : this.#rest }] };
  }
}
