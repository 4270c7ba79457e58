/**
 * The split screen: the exact run on the one side, the same start in ticks on the other.
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {{x: number, y: number, width: number, height: number}} Viewport
 */
import { at, element, put } from "./dom.js";
import { count, part, short } from "./numbers.js";

const EVERY = 150; // milliseconds between changes
const ROUNDING = 1e-9; // of a length: less is no overlap

/**
 * Two equal viewports in the free part of the canvas, side by side or one above the other.
 * @param {number} width @param {number} top @param {number} bottom of the free part
 * @param {boolean} stacked
 * @returns {Viewport[]}
 */
export function halves(width, top, bottom, stacked) {
  const height = bottom - top;
  const size = stacked
    ? { width, height: Math.floor(height / 2) }
    : { width: Math.floor(width / 2), height };
  const second = stacked ? { x: 0, y: top + size.height } : { x: size.width, y: top };
  return [
    { x: 0, y: top, ...size },
    { ...second, ...size },
  ];
}

/**
 * The two keyframes around a moment, or the nearest twice.
 * @param {Keyframe[]} keyframes in order of time @param {number} t
 * @returns {[Keyframe, Keyframe] | null}
 */
export function around(keyframes, t) {
  if (keyframes.length === 0) return null;
  let k = keyframes.length - 1;
  while (k > 0 && keyframes[k - 1].t > t) k--;
  return [keyframes[Math.max(k - 1, 0)], keyframes[k]];
}

/** The numbers of both sides. */
export class Comparison {
  constructor() {
    this.place = at("comparison");
    this.sides = [side("Exact"), side("Ticks")];
    this.place.append(...this.sides.map((each) => each.place));
    this.shown = -Infinity;
  }

  /** @param {boolean} on */
  show(on) {
    this.place.hidden = !on;
    document.body.dataset.split = String(on);
  }

  /** @param {Viewport[]} viewports @param {number} top pixels of them that the heading takes */
  arrange(viewports, top) {
    viewports.forEach(({ x, y, width, height }, k) => {
      const { style } = this.sides[k].place;
      const parts = { x, y, width, height, top };
      for (const [name, value] of Object.entries(parts)) style.setProperty(`--${name}`, `${value}px`);
    });
  }

  /** @param {(Keyframe | undefined)[]} newest of each side @param {number | null} tick @param {number} now */
  update(newest, tick, now) {
    if (now - this.shown < EVERY) return;
    this.shown = now;
    put(this.sides[1].name, tick === null ? "Ticks" : `Ticks of ${short(tick)}`);
    newest.forEach((frame, k) => {
      if (frame === undefined) return;
      const { rows } = this.sides[k];
      put(rows.collisions, count(frame.collisions));
      put(rows.missed, count(frame.missed));
      put(rows.drift, frame.drift === 0 ? "0" : part(frame.drift));
      put(rows.overlap, frame.overlap < ROUNDING ? "none" : short(frame.overlap));
      rows.drift.dataset.verdict = verdict(Math.abs(frame.drift));
      rows.missed.dataset.verdict = frame.missed > 0 ? "poor" : "exact";
    });
  }
}

/** @param {number} drift */
const verdict = (drift) => (drift < 1e-9 ? "exact" : drift < 1e-3 ? "fair" : "poor");

/** @param {string} title */
function side(title) {
  const name = element("h2", {}, title);
  const make = () => element("dd", {}, "–");
  const rows = { collisions: make(), missed: make(), drift: make(), overlap: make() };
  const row = (/** @type {string} */ text, /** @type {HTMLElement} */ value, kind = "") =>
    element("div", { class: kind }, element("dt", {}, text), value);
  const list = element(
    "dl",
    {},
    row("energy drift", rows.drift, "big"),
    row("missed", rows.missed, "big"),
    row("collisions", rows.collisions),
    row("deepest overlap", rows.overlap),
  );
  return { place: element("section", { class: "side", "aria-label": title }, name, list), name, rows };
}
