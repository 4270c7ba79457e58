/**
 * The split screen: the exact run on the one side, the same start in ticks on the other.
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {{x: number, y: number, width: number, height: number}} Viewport
 */
import { at, element, put } from "./dom.js";
import { count, scientific, short } from "./numbers.js";

const EVERY = 150; // milliseconds between changes

/**
 * Two equal viewports in the free part of the canvas, side by side or one above the other.
 * @param {number} width @param {number} height of the free part
 * @param {boolean} stacked
 * @returns {Viewport[]}
 */
export function halves(width, height, stacked) {
  const size = stacked
    ? { width, height: Math.floor(height / 2) }
    : { width: Math.floor(width / 2), height };
  const second = stacked ? { x: 0, y: size.height } : { x: size.width, y: 0 };
  return [
    { x: 0, y: 0, ...size },
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
    this.sides = [side("exact"), side("ticks")];
    this.place.append(...this.sides.map((each) => each.place));
    this.shown = -Infinity;
  }

  /** @param {boolean} on */
  show(on) {
    this.place.hidden = !on;
    document.body.dataset.split = String(on);
  }

  /** @param {Viewport[]} viewports @param {number} top pixels that the heading takes */
  arrange(viewports, top) {
    viewports.forEach((viewport, k) => {
      const { style } = this.sides[k].place;
      style.setProperty("--x", `${viewport.x}px`);
      style.setProperty("--y", `${viewport.y + (viewport.y === 0 ? top : 0)}px`);
      style.setProperty("--width", `${viewport.width}px`);
    });
  }

  /** @param {(Keyframe | undefined)[]} newest of each side @param {number | null} tick @param {number} now */
  update(newest, tick, now) {
    if (now - this.shown < EVERY) return;
    this.shown = now;
    put(this.sides[1].name, tick === null ? "ticks" : `ticks of ${short(tick)}`);
    newest.forEach((frame, k) => {
      if (frame === undefined) return;
      const { rows } = this.sides[k];
      put(rows.collisions, count(frame.collisions));
      put(rows.missed, count(frame.missed));
      put(rows.drift, frame.drift === 0 ? "0" : scientific(frame.drift));
      put(rows.overlap, frame.overlap === 0 ? "0" : short(frame.overlap));
      this.sides[k].place.dataset.verdict = verdict(frame);
    });
  }
}

/** @param {Keyframe} frame */
function verdict({ drift, missed }) {
  const size = Math.abs(drift);
  if (size < 1e-9 && missed === 0) return "exact";
  return size < 1e-3 ? "fair" : "poor";
}

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
    row("collisions", rows.collisions),
    row("missed", rows.missed),
    row("deepest overlap", rows.overlap),
  );
  return { place: element("section", { class: "side", "aria-label": title }, name, list), name, rows };
}
