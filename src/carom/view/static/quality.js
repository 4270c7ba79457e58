/**
 * How much a picture may cost: measured, not guessed. Pure arithmetic, without WebGL.
 *
 * @typedef {object} Level
 * @property {string} name
 * @property {number} samples per pixel
 * @property {boolean} edges are the outlines of spheres smooth?
 * @property {number} shadow pixels along a side of the shadow map; 0: soft spots on the walls only
 * @property {number} finest pixels of the picture per pixel of the page, at most
 */

/** From the cheapest to the best. @type {Level[]} */
export const LEVELS = [
  { name: "coarse", samples: 0, edges: false, shadow: 0, finest: 0.75 },
  { name: "plain", samples: 0, edges: true, shadow: 0, finest: 1 },
  { name: "shadows", samples: 0, edges: true, shadow: 1024, finest: 1.5 },
  { name: "best", samples: 4, edges: true, shadow: 2048, finest: 2 },
];

const WINDOW = 15; // pictures in a row that are judged together
const SLOW = 38; // ms: fewer than 26 pictures per second; 30 may be the screen's own beat
const QUICK = 20; // ms: at the screen's beat of 60 per second or more
const ASLEEP = 3000; // ms: the page was hidden; says nothing of the cost
const PATIENCE = 6; // windows in a row that must be quick before more is tried
const LONGEST = 96; // windows

/** Software paints with the processor that also computes the motion: only few spheres get more. */
const FEW = 50;
const MANY = 20_000; // spheres, from which shadows and samples are not tried first
const SWARM = 50_000; // spheres, whose pixels overlap so much that the cheapest level takes fewer

/** @param {string} renderer the graphics unit's name for itself */
export const isSoftware = (renderer) =>
  /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);

/** Pixels of the picture per pixel of the page, at most. @param {number} level @param {number} n spheres */
export const finest = (level, n) => (level === 0 && n > SWARM ? 0.55 : LEVELS[level].finest);

/** Chooses the level from the times between pictures. */
export class Governor {
  /** @param {boolean} software */
  constructor(software) {
    this.software = software;
    this.most = LEVELS.length - 1;
    this.chosen = this.most;
    /** @type {number | null} */ this.forced = null;
    /** @type {number[]} */ this.times = [];
    this.quick = 0; // windows in a row
    this.patience = PATIENCE;
  }

  /** The level now, from 0. */
  get level() {
    return this.forced ?? this.chosen;
  }

  /** Keep to one level, for tests and pictures; null to choose again. @param {number | null} level */
  force(level) {
    if (level !== null && !(Number.isInteger(level) && level in LEVELS)) {
      throw new Error(`level ${level} is not 0 to ${LEVELS.length - 1}; give one of them or null`);
    }
    this.forced = level;
    this.#forget();
  }

  /** Another scene has other costs. @param {number} n spheres */
  start(n) {
    if (this.software) this.most = n > FEW ? 0 : 1;
    this.chosen = Math.min(this.most, n > MANY ? 1 : LEVELS.length - 1);
    this.patience = PATIENCE;
    this.#forget();
  }

  /** From a picture to the browser's next chance to draw it took so long. @param {number} time ms */
  took(time) {
    if (this.forced !== null || !(time < ASLEEP)) return;
    this.times.push(time);
    // Very slow pictures are not looked at fifteen times.
    const enough = this.times.length >= 4 && this.times.every((t) => t > 2 * SLOW);
    if (this.times.length < WINDOW && !enough) return;
    const middle = this.times.sort((a, b) => a - b)[this.times.length >> 1];
    this.times = [];
    if (middle > SLOW) this.#slower();
    else if (middle < QUICK) this.#faster();
    else this.quick = 0;
  }

  #slower() {
    // What was tried and failed is tried again only after a longer wait.
    if (this.quick < 0) this.patience = Math.min(LONGEST, 2 * this.patience);
    this.quick = 0;
    this.chosen = Math.max(0, this.chosen - 1);
  }

  #faster() {
    this.quick = Math.max(this.quick, 0) + 1;
    if (this.quick < this.patience || this.chosen >= this.most) return;
    this.chosen++;
    this.quick = -1; // on trial: cleared by the first good window
  }

  #forget() {
    this.times = [];
    this.quick = 0;
  }
}
