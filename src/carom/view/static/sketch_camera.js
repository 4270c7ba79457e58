/**
 * Processing's default camera, and what the mouse makes of it: the eye stands in front of the
 * middle of the sheet, as far away as makes one unit one pixel there.
 */
import { perspective } from "./matrix.js";
import { KIND, LINE, SHAPE_WORDS } from "./sketch_protocol.js";
import { MatrixStack } from "./stack.js";

/** @typedef {import("./sketch_protocol.js").Sheet} Sheet */

const HALF_ANGLE = Math.tan(Math.PI / 6); // half of 60°, from top to bottom
const STEEPEST = 1.5; // radians
const NEAREST = 0.01; // near and far ends of what is drawn, in distances of the eye
const FARTHEST = 100;
const TURN = 0.0065; // radians per pixel of the page
const KEY_TURN = 0.08; // radians per key
const KEY_ZOOM = 1.12;

export class SketchCamera {
  constructor() {
    this.version = 0; // counts changes
    this.azimuth = 0; // radians to the right
    this.height = 0; // radians upwards
    this.zoom = 1; // how many times closer
    /** Around what the view turns. @type {[number, number, number] | null} */
    this.center = null;
  }

  /** Stand where Processing stands. */
  reset() {
    this.azimuth = this.height = 0;
    this.zoom = 1;
    this.center = null;
    this.version++;
  }

  /** Whether it stands where Processing stands. */
  get isFront() {
    return this.azimuth === 0 && this.height === 0 && this.zoom === 1;
  }

  /** Turn by angles in radians. @param {number} right @param {number} up */
  turn(right, up) {
    this.azimuth += right;
    this.height = Math.min(STEEPEST, Math.max(-STEEPEST, this.height + up));
    this.version++;
  }

  /** Come closer (factor > 1) or go away. @param {number} factor */
  approach(factor) {
    this.zoom = Math.min(20, Math.max(0.05, this.zoom * factor));
    this.version++;
  }

  /**
   * From the sheet's places to the eye's, and on to the picture.
   * @param {Sheet} sheet
   */
  matrices(sheet) {
    const { width, height } = sheet;
    const away = (0.5 * height) / HALF_ANGLE;
    if (this.center === null && !this.isFront) this.center = middle(sheet);
    const [x, y, z] = this.center ?? [0.5 * width, 0.5 * height, 0];
    const stack = new MatrixStack();
    // The eye looks along −z with y up; the sheet's y points down.
    stack.translate(0, 0, -away);
    stack.scale(1, -1, 1);
    stack.translate(x - 0.5 * width, y - 0.5 * height, z);
    const distance = away - z;
    stack.translate(0, 0, distance * (1 - 1 / this.zoom));
    stack.rotate(-this.height, 1, 0, 0);
    stack.rotate(this.azimuth, 0, 1, 0);
    stack.translate(-x, -y, -z);
    const tanX = (HALF_ANGLE * width) / height;
    return {
      view: stack.top,
      projection: perspective(tanX, HALF_ANGLE, NEAREST * away, FARTHEST * away, 0, 0),
    };
  }
}

/**
 * The middle of the largest shape: as a rule the room that everything else moves in.
 * @param {Sheet} sheet
 * @returns {[number, number, number]}
 */
export function middle({ width, height, n, numbers, words }) {
  /** @type {[number, number, number]} */
  let found = [0.5 * width, 0.5 * height, 0];
  let most = 0;
  for (let i = 0; i < SHAPE_WORDS * n; i += SHAPE_WORDS) {
    if ((words[i + KIND] & 0xffff) === LINE) continue;
    let size = 0;
    for (let k = 0; k < 9; k++) size += numbers[i + k] ** 2;
    if (size > most) {
      most = size;
      found = [numbers[i + 9], numbers[i + 10], numbers[i + 11]];
    }
  }
  return found;
}

/**
 * Mouse and touch turn the view, the wheel zooms.
 * @param {HTMLCanvasElement} canvas @param {SketchCamera} camera
 */
export function attachPointer(canvas, camera) {
  /** @type {Map<number, {x: number, y: number}>} */
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (last === undefined) return;
    const before = down.size === 2 ? spread() : 0;
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (before > 0) camera.approach(spread() / before);
    else camera.turn((event.clientX - last.x) * TURN, (event.clientY - last.y) * TURN);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) =>
      down.delete(/** @type {PointerEvent} */ (event).pointerId),
    );
  }
  canvas.addEventListener("dblclick", () => camera.reset());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * [1, 30, 300][event.deltaMode];
      camera.approach(Math.exp(Math.max(-240, Math.min(240, -pixels)) * 0.0016));
    },
    { passive: false },
  );
}

/**
 * Move the view by a key; false if the key is none of its own.
 * @param {KeyboardEvent} event @param {SketchCamera} camera
 */
export function cameraKey(event, camera) {
  const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const turn = Object.entries(turns).find(([key]) => key === event.key)?.[1];
  if (turn !== undefined) camera.turn(turn[0] * KEY_TURN, turn[1] * KEY_TURN);
  else if (event.key === "+" || event.key === "=") camera.approach(KEY_ZOOM);
  else if (event.key === "-" || event.key === "_") camera.approach(1 / KEY_ZOOM);
  else return false;
  return true;
}
