/** The numbers on the page. */
import { at, put as write } from "./dom.js";
import { count, multiple, part, short } from "./numbers.js";

const EVERY = 100; // milliseconds between changes, which nobody could read faster
const SETTLED = 1500; // milliseconds until the speed reached is known
const WINDOW = 1; // seconds over which collisions per second are counted

/** @param {string} id @param {string} text */
const put = (id, text) => write(at(id), text);

export class Readout {
  constructor() {
    this.shown = -Infinity;
    this.steady = 0; // when the speed asked for last changed
    /** @type {{clock: number, collisions: number}[]} */ this.past = [];
    /** @type {import("./protocol.js").Keyframe | null} */ this.last = null;
  }

  /** @param {import("./protocol.js").Keyframe} frame */
  push(frame) {
    const before = this.past.at(-1);
    if (frame.scene !== this.last?.scene || frame.collisions < (before?.collisions ?? 0)) this.past = [];
    this.past.push({ clock: frame.clock, collisions: frame.collisions });
    while (this.past.length > 2 && frame.clock - this.past[0].clock > WINDOW) this.past.shift();
    if (!frame.playing || frame.speed !== this.last?.speed || frame.epoch !== this.last.epoch) {
      this.steady = performance.now();
    }
    this.last = frame;
  }

  /** Show the clock at `t`, and ten times a second everything else. @param {number} t @param {number} now */
  show(t, now) {
    const frame = this.last;
    if (frame === null) return;
    put("clock", t.toFixed(t < 1000 ? 2 : 1));
    if (now - this.shown < EVERY) return;
    this.shown = now;
    put("n", count(frame.n));
    put("collisions", count(frame.collisions));
    put("brief-collisions", count(frame.collisions));
    put("wall-collisions", count(frame.wallCollisions));
    put("rate", frame.playing ? this.#rate() : "–");
    put("kinetic", short(frame.kinetic, 4));
    const falls = frame.gravity.some((part) => part !== 0);
    this.#row("potential", falls, short(frame.potential, 4));
    this.#row("dissipated", Math.abs(frame.dissipated) > 1e-300, short(frame.dissipated, 4));
    this.#row("temperature", Number.isFinite(frame.temperature), short(frame.temperature, 4));
    this.#drift(frame.drift, Math.abs(frame.dissipated) > 1e-300);
    const lags = frame.playing && frame.reached < 0.9 * frame.speed && now - this.steady > SETTLED;
    put("lag", lags ? `running at ${multiple(frame.reached)}` : "");
  }

  #rate() {
    const [first, last] = [this.past[0], this.past[this.past.length - 1]];
    const seconds = last.clock - first.clock;
    return seconds > 0 ? short((last.collisions - first.collisions) / seconds) : "–";
  }

  /** @param {string} id @param {boolean} there @param {string} text */
  #row(id, there, text) {
    const row = /** @type {HTMLElement} */ (at(id).parentElement);
    row.hidden = !there;
    put(id, text);
  }

  /** One part in 10¹⁶ is an empty bar, everything a full one. @param {number} drift @param {boolean} lossy */
  #drift(drift, lossy) {
    const size = Math.abs(drift);
    const what = lossy ? "Energy with losses has" : "Energy has";
    put("drift", size === 0 ? `${what} not changed` : `${what} changed by ${part(drift)}`);
    const share = size > 0 ? Math.min(1, Math.max(0, (Math.log10(size) + 16) / 16)) : 0;
    const gauge = at("drift-gauge");
    gauge.style.setProperty("--share", String(Math.max(share, 0.02)));
    gauge.dataset.verdict = size < 1e-9 ? "exact" : size < 1e-3 ? "fair" : "poor";
  }
}
