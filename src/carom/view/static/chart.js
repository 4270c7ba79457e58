/** Small charts on a canvas: sharp on every screen, in the colours of the page. */
import { count, short } from "./numbers.js";

/**
 * @typedef {object} Line
 * @property {ArrayLike<number>} x
 * @property {ArrayLike<number>} y NaN breaks the line
 * @property {string} color name of a CSS property
 * @property {number} [width]
 * @property {number[]} [dash]
 * @property {ArrayLike<number>} [error] half the height of a band around the line
 *
 * @typedef {object} Axis
 * @property {number} low
 * @property {number} high
 * @property {string} label
 *
 * @typedef {object} Picture
 * @property {Axis} x
 * @property {Axis} y
 * @property {Line[]} lines the first lies at the bottom
 * @property {{width: number, heights: ArrayLike<number>, color: string}} [bars] from x = 0 on
 *
 * @typedef {object} Bar
 * @property {string} name
 * @property {number} value
 *
 * @typedef {{low: number, high: number, step: number}} Span an axis, and the distance of its ticks
 */

/** Round numbers, about `wanted` of them, from `low` to `high`. @param {number} low @param {number} high @param {number} wanted */
export function ticks(low, high, wanted) {
  const step = roundStep((high - low) / Math.max(1, wanted));
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  // Multiples of the step, not sums of it: 0.3, not 0.30000000000000004. And 0, never -0.
  const inverse = Math.round(1 / step);
  const at = (/** @type {number} */ k) => (step < 1 ? k / inverse : k * step) + 0;
  const values = last - first < 100 ? Array.from({ length: last - first + 1 }, (_, k) => at(first + k)) : [];
  return { values, step };
}

/** The nearest of 1, 2, 5 times a power of ten. @param {number} size */
export function roundStep(size) {
  if (!(size > 0) || !Number.isFinite(size)) return 1;
  const power = 10 ** Math.floor(Math.log10(size));
  const part = size / power;
  // The borders are the geometric means.
  return (part < Math.SQRT2 ? 1 : part < Math.sqrt(10) ? 2 : part < Math.sqrt(50) ? 5 : 10) * power;
}

/** A tick's number, with the digits its neighbours need. @param {number} value @param {number} step */
export function tickLabel(value, step) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || step < 1e-4) return short(value, 3);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const sign = value < 0 ? "−" : "";
  return sign + (decimals > 0 ? size.toFixed(decimals) : count(size));
}

/**
 * An axis that holds all the values, with some air, and is never empty.
 * @param {ArrayLike<number>[]} columns @param {{zero?: boolean, least?: number}} [more] `zero` is in it; `least` height
 * @returns {{low: number, high: number}}
 */
export function span(columns, { zero = false, least = 0 } = {}) {
  let low = zero ? 0 : Infinity;
  let high = zero ? 0 : -Infinity;
  for (const column of columns) {
    for (let k = 0; k < column.length; k++) {
      if (column[k] < low) low = column[k];
      if (column[k] > high) high = column[k];
    }
  }
  if (low > high) [low, high] = [0, 1];
  const height = Math.max(high - low, least, 1e-12 * Math.max(Math.abs(low), Math.abs(high)));
  const grown = (height || 1) * 1.12;
  const middle = (low + high) / 2;
  if (zero && low === 0) return { low: 0, high: Math.max(high, grown) };
  if (zero && high === 0) return { low: Math.min(low, -grown), high: 0 };
  return { low: middle - grown / 2, high: middle + grown / 2 };
}

const SMALL = 13; // css pixels of the page's text at which a chart is drawn in its natural size
const FONT = "11px system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', 'Noto Sans', sans-serif";
const TOP = 20; // css pixels above the plot, for the label of the y axis
const BOTTOM = 33; // below, for the numbers and the label of the x axis
const RIGHT = 10;
const FINEST = 3; // pixels of the screen per css pixel

/** A canvas cleared, with css pixels as its unit, or more where the page's text is large, and the page's colours. @param {HTMLCanvasElement} canvas */
function begin(canvas) {
  const zoom = Math.max(1, parseFloat(getComputedStyle(document.documentElement).fontSize) / SMALL);
  const [width, height] = [canvas.clientWidth / zoom, canvas.clientHeight / zoom];
  const ratio = Math.min(devicePixelRatio, FINEST) * zoom;
  const size = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = FONT;
  pen.lineJoin = "round";
  const style = getComputedStyle(canvas);
  return {
    pen,
    width,
    height,
    paint: (/** @type {string} */ name) => style.getPropertyValue(name).trim() || "gray",
    /** On the middle of a pixel of the screen, where thin lines are sharp. @param {number} at */
    sharp: (at) => (Math.round(at * ratio - 0.5) + 0.5) / ratio,
  };
}

/** @param {HTMLCanvasElement} canvas @param {Picture} picture */
export function drawChart(canvas, picture) {
  const paper = begin(canvas);
  if (paper.width === 0 || paper.height === 0) return;
  const { pen, width, height, paint } = paper;
  const { x, y } = picture;
  const yTicks = ticks(y.low, y.high, (height - TOP - BOTTOM) / 34);
  const names = yTicks.values.map((value) => tickLabel(value, yTicks.step));
  const left = 8 + Math.max(12, ...names.map((name) => pen.measureText(name).width));
  const right = width - RIGHT;
  const bottom = height - BOTTOM;
  const px = (/** @type {number} */ at) => left + ((at - x.low) / (x.high - x.low)) * (right - left);
  const py = (/** @type {number} */ at) => bottom - ((at - y.low) / (y.high - y.low)) * (bottom - TOP);

  pen.lineWidth = 1;
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  for (const [k, value] of yTicks.values.entries()) {
    pen.strokeStyle = paint(value === 0 ? "--plot-axis" : "--plot-grid");
    rule(pen, left, paper.sharp(py(value)), right, paper.sharp(py(value)));
    pen.fillStyle = paint("--plot-text");
    pen.fillText(names[k], left - 6, py(value));
  }
  pen.textBaseline = "alphabetic";
  pen.textAlign = "left";
  pen.fillStyle = paint("--plot-text");
  pen.fillText(y.label, 1, 11);
  drawXAxis(paper, x, left, right, bottom);

  pen.save();
  pen.beginPath();
  pen.rect(left, TOP - 4, right - left, bottom - TOP + 5);
  pen.clip();
  if (picture.bars) drawHistogram(paper, picture.bars, px, py);
  for (const line of picture.lines) drawLine(paper, line, px, py);
  pen.restore();
}

/** Ticks, their numbers and the label below. @param {ReturnType<typeof begin>} paper @param {Axis} x @param {number} left @param {number} right @param {number} bottom */
function drawXAxis({ pen, width, paint, sharp }, x, left, right, bottom) {
  pen.textBaseline = "alphabetic";
  pen.textAlign = "center";
  pen.fillStyle = paint("--plot-text");
  pen.strokeStyle = paint("--plot-axis");
  pen.fillText(x.label, (left + right) / 2, bottom + 29);
  for (const { at, name } of fitting(pen, x, right - left)) {
    const place = left + ((at - x.low) / (x.high - x.low)) * (right - left);
    const half = pen.measureText(name).width / 2;
    rule(pen, sharp(place), bottom, sharp(place), bottom + 4);
    pen.fillText(name, Math.min(place, width - half), bottom + 15);
  }
}

/** As many ticks as have room for their numbers. @param {CanvasRenderingContext2D} pen @param {Axis} x @param {number} room */
function fitting(pen, { low, high }, room) {
  for (let wanted = Math.floor(room / 45); ; wanted--) {
    const { values, step } = ticks(low, high, wanted);
    const names = values.map((value) => tickLabel(value, step));
    const longest = Math.max(0, ...names.map((name) => pen.measureText(name).width));
    if (wanted <= 1 || (longest + 14) * values.length < room) {
      return values.map((at, k) => ({ at, name: names[k] }));
    }
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} x0 @param {number} y0 @param {number} x1 @param {number} y1 */
function rule(pen, x0, y0, x1, y1) {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

/** @typedef {(at: number) => number} Map1 */

/** @param {ReturnType<typeof begin>} paper @param {NonNullable<Picture["bars"]>} bars @param {Map1} px @param {Map1} py */
function drawHistogram({ pen, paint }, { width, heights, color }, px, py) {
  pen.fillStyle = paint(color);
  for (let k = 0; k < heights.length; k++) {
    const from = px(k * width) + 0.5;
    pen.fillRect(from, py(heights[k]), px((k + 1) * width) - 0.5 - from, py(0) - py(heights[k]));
  }
}

/** @param {ReturnType<typeof begin>} paper @param {Line} line @param {Map1} px @param {Map1} py */
function drawLine({ pen, paint }, line, px, py) {
  const { x, y, error } = line;
  const color = paint(line.color);
  if (error) {
    pen.globalAlpha = 0.22;
    pen.fillStyle = color;
    for (let k = 0; k + 1 < x.length; k++) {
      if (Number.isNaN(y[k] + y[k + 1])) continue;
      pen.beginPath();
      pen.moveTo(px(x[k]), py(y[k] - error[k]));
      pen.lineTo(px(x[k]), py(y[k] + error[k]));
      pen.lineTo(px(x[k + 1]), py(y[k + 1] + error[k + 1]));
      pen.lineTo(px(x[k + 1]), py(y[k + 1] - error[k + 1]));
      pen.fill();
    }
    pen.globalAlpha = 1;
  }
  pen.strokeStyle = color;
  pen.fillStyle = color;
  pen.lineWidth = line.width ?? 1.75;
  pen.setLineDash(line.dash ?? []);
  pen.beginPath();
  for (let k = 0; k < x.length; k++) {
    if (Number.isNaN(y[k])) continue;
    if (k === 0 || Number.isNaN(y[k - 1])) pen.moveTo(px(x[k]), py(y[k]));
    else pen.lineTo(px(x[k]), py(y[k]));
  }
  pen.stroke();
  pen.setLineDash([]);
  // A value with nothing on either side is a dot, or it would not be seen.
  for (let k = 0; k < x.length; k++) {
    if (Number.isNaN(y[k]) || !(Number.isNaN(y[k - 1] ?? NaN) && Number.isNaN(y[k + 1] ?? NaN))) continue;
    pen.beginPath();
    pen.arc(px(x[k]), py(y[k]), 2, 0, 7);
    pen.fill();
  }
}

const ROW = 20; // css pixels of a bar and its name
const HEAD = 2;

/** Height of a picture of so many bars. @param {number} n */
export const barsHeight = (n) => HEAD + n * ROW + BOTTOM;

/**
 * One bar per name, and a line across all where theory is known.
 * @param {HTMLCanvasElement} canvas @param {Bar[]} bars @param {{color: string, label: string, theory: number | null}} look
 */
export function drawBars(canvas, bars, { color, label, theory }) {
  const paper = begin(canvas);
  if (paper.width === 0 || paper.height === 0) return;
  const { pen, width, paint } = paper;
  const left = 12 + Math.max(...bars.map(({ name }) => pen.measureText(name).width));
  const right = width - RIGHT;
  const bottom = HEAD + bars.length * ROW;
  const { high } = span([bars.map(({ value }) => value), [theory ?? 0]], { zero: true });
  const px = (/** @type {number} */ at) => left + (at / high) * (right - left);
  pen.textBaseline = "middle";
  pen.lineWidth = 1;
  for (const [k, { name, value }] of bars.entries()) {
    const middle = HEAD + (k + 0.5) * ROW;
    pen.textAlign = "right";
    pen.fillStyle = paint("--plot-text");
    pen.fillText(name, left - 6, middle);
    pen.fillStyle = paint(color);
    pen.fillRect(left, middle - 6, Math.max(0, px(value) - left), 12);
  }
  pen.strokeStyle = paint("--plot-axis");
  rule(pen, paper.sharp(left), HEAD, paper.sharp(left), bottom);
  rule(pen, left, paper.sharp(bottom), right, paper.sharp(bottom));
  drawXAxis(paper, { low: 0, high, label }, left, right, bottom);
  if (theory === null) return;
  pen.strokeStyle = paint("--plot-theory");
  pen.lineWidth = 2;
  pen.setLineDash([5, 3]);
  rule(pen, paper.sharp(px(theory)), HEAD, paper.sharp(px(theory)), bottom);
  pen.setLineDash([]);
}
