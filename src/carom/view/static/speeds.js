/** How fast the spheres are, and whether that is what theory says. */
import { SpeedLaw, compare, maxwell } from "./statistics.js";

const BARS = 24;
const MOST = 20000; // spheres looked at; of more, every second, third …
const POOL = 2000; // speeds remembered from earlier moments
const APART = 4; // collisions of each sphere between moments that count as independent
const ENOUGH = 40; // speeds before anything is said
const MANY = 200; // spheres for whom the exact law is Maxwell's and Boltzmann's
const RANGE = 4.5; // of the histogram, in units of √(kT/m)
const PLANE = 0;
const SPHERE = 1;

/**
 * @typedef {"agrees" | "doubtful" | "not" | "collecting" | "ideal" | "single" | "still"} Opinion
 *
 * @typedef {object} Histogram
 * @property {number} width of a bar, in the units of the axis
 * @property {Float64Array} bars density of each
 * @property {number} samples
 * @property {boolean} scaled the axis is v √(m/kT), because masses differ
 * @property {{x: Float64Array, y: Float64Array} | null} law
 * @property {{x: Float64Array, y: Float64Array} | null} maxwell drawn too where few spheres make a difference
 * @property {Opinion} opinion
 * @property {import("./statistics.js").Fit | null} fit
 */

/**
 * The axes along which nothing changes the total momentum. The server counts them; which they are
 * follows from the walls.
 * @param {import("./protocol.js").About} about @returns {number[]}
 */
export function freeAxes(about) {
  if (about.free_axes === 0) return [];
  const broken = about.gravity.map((part) => part !== 0);
  for (const { kind, normal } of about.walls) {
    if (kind === SPHERE) return [];
    for (let k = 0; k < 3; k++) broken[k] ||= kind === PLANE ? normal[k] !== 0 : k < 2;
  }
  const free = [0, 1, 2].filter((k) => !broken[k]);
  return free.length === about.free_axes ? free : [];
}

export class Speeds {
  constructor() {
    this.law = /** @type {SpeedLaw | null} */ (null);
    this.free = new Uint32Array(0); // the spheres that are not fixed
    this.mass = new Float64Array(0); // of those
    /** @type {number[]} */ this.axes = [];
    this.total = 0; // their mass
    this.equal = true;
    this.collide = true;
    this.buffer = new Float32Array(POOL + MOST);
    this.pool = new Float32Array(POOL); // moments one after the other, as a ring
    this.marks = new Float64Array(0); // when each was: collisions of each sphere
    this.each = 0; // spheres looked at in one moment
    this.turn = 0; // which sphere, or which of every few, is looked at
    this.epoch = -1;
    this.stored = 0; // moments, also those that newer ones have replaced
    this.start = NaN; // collisions of each sphere at the first moment
    this.latest = -Infinity; // and at the last one stored
  }

  clear() {
    this.stored = 0;
    this.start = NaN;
    this.latest = -Infinity;
  }

  /** @param {import("./protocol.js").Scene} scene */
  setScene(scene) {
    const { mass, about } = scene;
    this.free = Uint32Array.from(mass.keys()).filter((i) => Number.isFinite(mass[i]));
    this.mass = Float64Array.from(this.free, (i) => mass[i]);
    this.total = this.mass.reduce((sum, part) => sum + part, 0);
    this.equal = this.mass.every((part) => part === this.mass[0]);
    this.collide = about.collide;
    this.axes = freeAxes(about);
    const freedom = 3 * this.free.length - this.axes.length;
    if (freedom !== this.law?.freedom) this.law = freedom > 3 ? new SpeedLaw(freedom) : null;
    // The speeds of two spheres that share an energy are one number, so one of the two counts.
    const n = this.free.length;
    this.each = n === 2 ? 1 : Math.min(n, Math.ceil(n / Math.ceil(n / MOST)));
    this.marks = new Float64Array(this.each > 0 ? Math.floor(POOL / this.each) : 0);
    this.clear();
  }

  /** Remember this moment if it owes nothing to the last. @param {import("./protocol.js").Keyframe} frame */
  offer(frame) {
    const reached = (2 * frame.collisions) / this.free.length;
    if (frame.epoch !== this.epoch || !(reached >= this.latest)) this.clear();
    this.epoch = frame.epoch;
    if (Number.isNaN(this.start)) this.start = reached;
    if (this.marks.length < 2 || reached - this.latest < APART) return;
    const place = this.stored % this.marks.length;
    this.#look(frame, this.pool.subarray(place * this.each, (place + 1) * this.each));
    this.marks[place] = reached;
    this.latest = reached;
    this.stored++;
  }

  /**
   * Speeds in units of √(kT/m), relative to the common motion; where momentum is conserved a sphere
   * has a little less than its share, m/M, because the others balance it.
   * @param {import("./protocol.js").Keyframe} frame @param {Float32Array} into
   * @returns {number} kT
   */
  #look(frame, into) {
    const { free, mass, total } = this;
    const { velocity } = frame;
    const drift = [0, 0, 0];
    for (const k of this.axes) {
      for (let i = 0; i < free.length; i++) drift[k] += mass[i] * velocity[3 * free[i] + k];
      drift[k] /= total;
    }
    const [dx, dy, dz] = drift;
    let twice = 0;
    for (let i = 0; i < free.length; i++) {
      const at = 3 * free[i];
      const x = velocity[at] - dx;
      const y = velocity[at + 1] - dy;
      const z = velocity[at + 2] - dz;
      twice += mass[i] * (x * x + y * y + z * z);
    }
    const kT = twice / (this.law?.freedom ?? 3 * free.length);
    const stride = Math.floor(free.length / into.length);
    const [tiedX, tiedY, tiedZ] = [0, 1, 2].map((k) => this.axes.includes(k));
    this.turn++;
    for (let j = 0; j < into.length; j++) {
      const i = Math.min(j * stride + (this.turn % stride), free.length - 1);
      const at = 3 * free[i];
      const x = velocity[at] - dx;
      const y = velocity[at + 1] - dy;
      const z = velocity[at + 2] - dz;
      const own = mass[i];
      const tied = total > own ? total / (total - own) : 1;
      const sum = (tiedX ? tied : 1) * x * x + (tiedY ? tied : 1) * y * y + (tiedZ ? tied : 1) * z * z;
      into[j] = Math.sqrt((own * sum) / kT);
    }
    return kT;
  }

  /** @param {import("./protocol.js").Keyframe} frame @returns {Histogram} */
  histogram(frame) {
    this.offer(frame);
    const { buffer, law } = this;
    const alone = this.free.length === 1 && this.axes.length === 3; // relative to itself it rests
    let n = this.each;
    const kT = this.free.length > 0 ? this.#look(frame, buffer.subarray(0, n)) : 0;
    const still = alone || !(kT > 0);
    if (still) n = 0;
    else n = this.#gather((2 * frame.collisions) / this.free.length, n);
    const range = Math.min(RANGE, law?.limit ?? RANGE);
    const tied = this.axes.length === 3 && this.free.length > 1 ? this.total / (this.total - this.mass[0]) : 1;
    const unit = this.equal && !still ? Math.sqrt(kT / (this.mass[0] * tied)) : 1;
    const width = (range / BARS) * unit;
    const bars = new Float64Array(BARS);
    const share = 1 / (Math.max(1, n) * width);
    for (let k = 0; k < n; k++) {
      const bar = Math.floor((buffer[k] * BARS) / range);
      if (bar < BARS) bars[bar] += share;
    }
    const few = this.free.length < MANY;
    const root = Math.sqrt(tied);
    return {
      width,
      bars,
      samples: n,
      scaled: !this.equal,
      law: law && curve(range, unit, (u) => law.density(u)),
      maxwell: few ? curve(range, unit, (u) => maxwell(u / root) / root) : null,
      ...this.#judge(n, still),
    };
  }

  /** Put remembered speeds behind those of now; how many there are then. @param {number} reached @param {number} n */
  #gather(reached, n) {
    // The start is forgotten: what counts is the later half of the motion.
    const oldest = (this.start + reached) / 2;
    const kept = Math.min(this.stored, this.marks.length);
    for (let k = 0; k < kept; k++) {
      if (this.marks[k] < oldest || this.marks[k] > reached - APART) continue;
      this.buffer.set(this.pool.subarray(k * this.each, (k + 1) * this.each), n);
      n += this.each;
    }
    return n;
  }

  /** @param {number} n @param {boolean} still @returns {{opinion: Opinion, fit: import("./statistics.js").Fit | null}} */
  #judge(n, still) {
    if (still) return { opinion: "still", fit: null };
    if (!this.collide) return { opinion: "ideal", fit: null };
    if (this.law === null) return { opinion: "single", fit: null };
    if (n < ENOUGH) return { opinion: "collecting", fit: null };
    // The temperature came from the same spheres: that takes one degree of freedom, or the
    // part of one that the spheres looked at are of all.
    const count = this.free.length;
    const taken = count === 2 ? 0 : this.each / count;
    const fit = compare(this.law, this.buffer, n, taken);
    return { opinion: fit.p >= 0.01 ? "agrees" : fit.p >= 0.001 ? "doubtful" : "not", fit };
  }
}

const POINTS = 90;

/** @param {number} range @param {number} unit @param {(u: number) => number} density */
function curve(range, unit, density) {
  const x = new Float64Array(POINTS);
  const y = new Float64Array(POINTS);
  for (let k = 0; k < POINTS; k++) {
    // Points between the ends: the law of five degrees of freedom and fewer is infinite at its end.
    const u = (range * (k + 0.5)) / POINTS;
    x[k] = u * unit;
    y[k] = density(u) / unit;
  }
  return { x, y };
}

/** The verdict in words. @param {Histogram} histogram @param {number} spheres */
export function verdict({ opinion, fit, samples }, spheres) {
  const law = spheres < MANY ? `the exact law of ${spheres} spheres` : "Maxwell–Boltzmann";
  if (opinion === "still") return "Nothing moves.";
  if (opinion === "ideal") return "In an ideal gas nothing mixes the speeds: each sphere keeps its own.";
  if (opinion === "single") return "Energy and momentum leave only one speed possible.";
  if (opinion === "collecting") return `Collecting: ${samples} of ${ENOUGH} independent speeds.`;
  const { ratio, p } = /** @type {import("./statistics.js").Fit} */ (fit);
  const size = ratio < 10 ? ratio.toFixed(1) : ratio.toFixed(0);
  const numbers = `χ²/df ${ratio < 1000 ? `= ${size}` : "> 1000"}, ${chance(p)}`.replace(/ ([=<>]) /g, "\u00a0$1\u00a0");
  if (opinion === "agrees") return `Agrees with ${law}: ${numbers}.`;
  if (opinion === "doubtful") return `Hardly ${law}: ${numbers}.`;
  return `Not yet ${law}: ${numbers}.`;
}

/** @param {number} p */
const chance = (p) => (p < 0.001 ? "p < 0.001" : `p = ${p < 0.0995 ? p.toPrecision(1) : p.toFixed(2)}`);
