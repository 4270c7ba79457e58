/** What happened lately, in memory that does not grow. */

/**
 * Rows of numbers, the oldest overwritten by the newest. The first column is the time, which never
 * falls: going back in time forgets what came later. A row of NaN breaks the lines.
 */
export class Trace {
  /** @param {number} columns time included @param {number} [capacity] rows */
  constructor(columns, capacity = 400) {
    this.columns = columns;
    this.capacity = capacity;
    this.rows = new Float64Array(columns * capacity);
    this.first = 0;
    this.length = 0;
  }

  clear() {
    this.first = 0;
    this.length = 0;
  }

  /** @param {...number} row */
  push(...row) {
    this.forget(row[0]);
    this.#add(row);
  }

  /** Lines do not go on from the last row to the next. */
  cut() {
    if (this.length > 0 && !Number.isNaN(this.at(this.length - 1, 1))) {
      this.#add([this.end, ...Array(this.columns - 1).fill(NaN)]);
    }
  }

  /** Drop what came after a moment. @param {number} t */
  forget(t) {
    while (this.length > 0 && this.at(this.length - 1, 0) > t) this.length--;
  }

  /** @param {number[]} row */
  #add(row) {
    if (this.length === this.capacity) {
      this.first = (this.first + 1) % this.capacity;
      this.length--;
    }
    this.rows.set(row, ((this.first + this.length) % this.capacity) * this.columns);
    this.length++;
  }

  /** @param {number} k from the oldest @param {number} column */
  at(k, column) {
    return this.rows[((this.first + k) % this.capacity) * this.columns + column];
  }

  /** Time of the oldest row. */
  get start() {
    return this.length > 0 ? this.at(0, 0) : 0;
  }

  /** Time of the newest row. */
  get end() {
    return this.length > 0 ? this.at(this.length - 1, 0) : 0;
  }

  /** The largest size in a column; breaks do not count. @param {number} column */
  largest(column) {
    return this.column(column).reduce((most, part) => (Math.abs(part) > most ? Math.abs(part) : most), 0);
  }

  /** @param {number} column @returns {Float64Array} oldest first */
  column(column) {
    return Float64Array.from({ length: this.length }, (_, k) => this.at(k, column));
  }
}

/** Says whether the motion has jumped since the last keyframe. */
export class Jumps {
  constructor() {
    this.epoch = -1;
    this.t = -Infinity;
  }

  /** @param {{epoch: number, t: number}} frame */
  happened(frame) {
    const jump = this.epoch >= 0 && (frame.epoch !== this.epoch || frame.t < this.t);
    this.epoch = frame.epoch;
    this.t = frame.t;
    return jump;
  }
}

const SOON = 0.25; // seconds: collisions are counted for at least that long,
const ENOUGH = 400; // until there are so many (an error of 5 %),
const PATIENCE = 2; // or, after so many seconds,
const FEW = 25; // at least so many (20 %)
const RECENT = 12; // counts that make the number shown

/** Collisions per unit of simulated time, counted until there are enough to tell. */
export class RateMeter {
  constructor() {
    /** time, rate, error, theory; collisions and duration, to add up. */
    this.trace = new Trace(6, 240);
    /** @type {{t: number, clock: number, collisions: number} | null} */ this.from = null;
  }

  clear() {
    this.trace.clear();
    this.from = null;
  }

  /** The motion has jumped to `t`. @param {number} t */
  jump(t) {
    this.trace.forget(t);
    this.trace.cut();
    this.from = null;
  }

  /**
   * @param {{t: number, clock: number, collisions: number}} frame
   * @param {number} theory NaN where there is none
   */
  push({ t, clock, collisions }, theory) {
    const { from } = this;
    if (from === null) {
      this.from = { t, clock, collisions };
      return;
    }
    const seconds = clock - from.clock;
    const counted = collisions - from.collisions;
    const duration = t - from.t;
    const full = counted >= ENOUGH && seconds >= SOON;
    if (!(full || (counted >= FEW && seconds >= PATIENCE)) || !(duration > 0)) return;
    const rate = counted / duration;
    const error = Math.sqrt(counted) / duration;
    this.trace.push((from.t + t) / 2, rate, error, theory, counted, duration);
    this.from = { t, clock, collisions };
  }

  /** Mean of the last counts, since the last jump, and its error. @returns {{rate: number, error: number} | null} */
  recent() {
    let counted = 0;
    let duration = 0;
    const { trace } = this;
    for (let k = trace.length - 1; k >= Math.max(0, trace.length - RECENT); k--) {
      if (Number.isNaN(trace.at(k, 1))) break;
      counted += trace.at(k, 4);
      duration += trace.at(k, 5);
    }
    return duration > 0 ? { rate: counted / duration, error: Math.sqrt(counted) / duration } : null;
  }
}

const FREEZING = 0.49; // packing fraction above which a fluid crystallises, and this theory ends
const PLANE = 0;
const CROWD = 20; // spheres; fewer are no bulk

/**
 * Collisions between spheres per unit of time by Enskog's theory, for √(kT) = 1; NaN where it does
 * not apply. A sphere meets others at the rate ω = 4 n σ² g √(πkT/m), with the contact value of
 * N. Carnahan and K. Starling, g = (1 - φ/2)/(1 - φ)³; each collision is of two.
 * @param {import("./protocol.js").Scene} scene
 */
export function enskog({ n, radius, mass, about }) {
  const same = radius.every((part) => part === radius[0]) && mass.every((part) => part === mass[0]);
  if (!same || n < CROWD || !Number.isFinite(mass[0]) || !about.collide) return NaN;
  const volume = boxVolume(about);
  const phi = (n * (4 / 3) * Math.PI * radius[0] ** 3) / volume;
  if (!(phi < FREEZING)) return NaN;
  const contact = (1 - phi / 2) / (1 - phi) ** 3;
  const diameter = 2 * radius[0];
  const omega = 4 * (n / volume) * diameter ** 2 * contact * Math.sqrt(Math.PI / mass[0]);
  return (n * omega) / 2;
}

/** Of a box of periods and planes along the axes; NaN for others. @param {import("./protocol.js").About} about */
export function boxVolume({ period, walls }) {
  if (walls.some(({ kind, normal }) => kind !== PLANE || normal.filter((part) => part).length !== 1)) {
    return NaN;
  }
  return [0, 1, 2].reduce((volume, axis) => {
    if (period[axis] > 0) return volume * period[axis];
    const low = walls.filter(({ normal }) => normal[axis] > 0).map(({ offset }) => offset);
    const high = walls.filter(({ normal }) => normal[axis] < 0).map(({ offset }) => -offset);
    return low.length && high.length ? volume * (Math.min(...high) - Math.max(...low)) : NaN;
  }, 1);
}
