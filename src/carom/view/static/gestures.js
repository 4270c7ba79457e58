/**
 * Mouse, touch and keys that move the camera. What a tool wants for itself goes to the tool:
 * taps, and drags that begin where it says so.
 *
 * @typedef {object} Drag a pointer that belongs to a tool until it is lifted
 * @property {(x: number, y: number) => void} move
 * @property {() => void} end
 * @property {() => void} cancel
 *
 * @typedef {object} Tool places are pixels from the canvas's upper left corner, y downwards
 * @property {(x: number, y: number) => Drag | null} grab a pointer went down: does it belong to you?
 * @property {(x: number, y: number, touch: boolean) => void} tap
 * @property {(x: number, y: number) => void} twice two taps at one place
 * @property {(x: number, y: number) => void} hover
 */

const TURN = 0.0065; // radians per pixel
const KEY_TURN = 0.08; // radians per key
const KEY_PAN = 24; // pixels per key
const KEY_ZOOM = 1.12;
const STILL = 5; // pixels: a pointer that moved less has only tapped
const SOON = 350; // milliseconds between two taps of one double tap
const NEAR = 24; // pixels between them
const LOOSE = 30; // pixels two fingers must move together before they let go of a followed sphere

/** @typedef {{x: number, y: number}} Place */

/**
 * @param {HTMLCanvasElement} canvas
 * @param {import("./camera.js").Camera} camera
 * @param {Tool} tool
 */
export function attachPointers(canvas, camera, tool) {
  const pointers = new Pointers(canvas, camera, tool);
  canvas.addEventListener("pointerdown", (event) => pointers.press(event));
  canvas.addEventListener("pointermove", (event) => pointers.move(event));
  canvas.addEventListener("pointerup", (event) => pointers.lift(event, false));
  canvas.addEventListener("pointercancel", (event) => pointers.lift(event, true));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * [1, 30, 300][event.deltaMode];
      const factor = Math.exp(Math.max(-240, Math.min(240, pixels)) * 0.0016);
      camera.glide(() => camera.zoom(factor));
    },
    { passive: false },
  );
}

class Pointers {
  /** @param {HTMLCanvasElement} canvas @param {import("./camera.js").Camera} camera @param {Tool} tool */
  constructor(canvas, camera, tool) {
    this.canvas = canvas;
    this.camera = camera;
    this.tool = tool;
    /** Those that are down. @type {Map<number, Place>} */ this.down = new Map();
    /** @type {Drag | null} */ this.drag = null;
    /** Where the only pointer went down, as long as it may still be a tap. @type {Place | null} */
    this.start = null;
    this.last = { x: 0, y: 0, time: -Infinity }; // tap
    this.loose = 0; // pixels that two fingers have moved together
  }

  /** @param {MouseEvent} event @returns {Place} */
  #place(event) {
    const { left, top } = this.canvas.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  }

  /** @param {PointerEvent} event */
  press(event) {
    const here = this.#place(event);
    this.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, here);
    if (this.down.size > 1) {
      // A second finger: it is the camera that is meant.
      this.drag?.cancel();
      this.drag = this.start = null;
      this.loose = 0;
      return;
    }
    const main = event.button === 0 && !event.shiftKey;
    this.drag = main ? this.tool.grab(here.x, here.y) : null;
    this.start = main && this.drag === null ? here : null;
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { camera, down, start } = this;
    const here = this.#place(event);
    const before = down.get(event.pointerId);
    if (before === undefined) {
      if (event.pointerType !== "touch" && down.size === 0) this.tool.hover(here.x, here.y);
      return;
    }
    if (this.drag !== null) return this.drag.move(here.x, here.y);
    if (start !== null && Math.hypot(here.x - start.x, here.y - start.y) < STILL) return;
    this.start = null;
    if (down.size >= 2) return this.#pinch(event.pointerId, here);
    down.set(event.pointerId, here);
    const [x, y] = [here.x - before.x, here.y - before.y];
    if (event.buttons & 6 || event.shiftKey) camera.pan(x, y);
    else camera.turn(x * TURN, y * TURN);
  }

  /** @param {number} pointer @param {Place} here */
  #pinch(pointer, here) {
    const { camera } = this;
    const before = this.#spread();
    this.down.set(pointer, here);
    const after = this.#spread();
    const [x, y] = [after.x - before.x, after.y - before.y];
    this.loose += Math.hypot(x, y);
    if (!camera.follows || this.loose > LOOSE) camera.pan(x, y);
    if (before.d > 0 && after.d > 0) camera.zoom(before.d / after.d);
  }

  /** The middle of two fingers and their distance. */
  #spread() {
    const [a, b] = [...this.down.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, d: Math.hypot(a.x - b.x, a.y - b.y) };
  }

  /** @param {PointerEvent} event @param {boolean} lost the browser took the pointer away */
  lift(event, lost) {
    if (!this.down.delete(event.pointerId)) return;
    if (lost) this.drag?.cancel();
    else {
      this.drag?.end();
      if (this.start !== null) this.#tap(this.#place(event), event.pointerType === "touch");
    }
    this.drag = this.start = null;
  }

  /** @param {Place} here @param {boolean} touch */
  #tap({ x, y }, touch) {
    const { last } = this;
    const time = performance.now();
    const twice = time - last.time < SOON && Math.hypot(x - last.x, y - last.y) < NEAR;
    this.last = { x, y, time: twice ? -Infinity : time };
    if (twice) this.tool.twice(x, y);
    else this.tool.tap(x, y, touch);
  }
}

/**
 * Move the camera by a key; false if the key is none of its own.
 * @param {KeyboardEvent} event @param {import("./camera.js").Camera} camera
 */
export function cameraKey(event, camera) {
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[
    event.key
  ];
  if (arrow !== undefined) {
    const [x, y] = arrow;
    camera.glide(() => {
      if (event.shiftKey) camera.pan(-x * KEY_PAN, -y * KEY_PAN);
      else camera.turn(x * KEY_TURN, -y * KEY_TURN);
    });
    return true;
  }
  if (event.key === "+" || event.key === "=") camera.glide(() => camera.zoom(1 / KEY_ZOOM));
  else if (event.key === "-" || event.key === "_") camera.glide(() => camera.zoom(KEY_ZOOM));
  else return false;
  return true;
}
