/**
 * The end of a velocity's arrow, to be dragged: an element over the picture, so that mouse,
 * finger and keyboard can all take it.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {import("./camera.js").Camera} Camera
 */
import { arrowEnds, velocityTo } from "./arrows.js";
import { add, length, scale } from "./matrix.js";
import { short } from "./numbers.js";

const EDGE = 14; // pixels from the border of the viewport where the handle stops
const KEY = 0.04; // of the scene's high speed, per arrow key
const PATIENCE = 1500; // milliseconds until a wish that changed nothing is given up

/**
 * @typedef {{x: number, y: number, width: number, height: number}} Viewport
 * @typedef {{x: Vec3, v: Vec3, radius: number, viewport: Viewport}} Ball
 */

/** A few words beside a place of the picture, read out as they change. */
export class Label {
  /** @param {HTMLElement} parent */
  constructor(parent) {
    this.element = document.createElement("output");
    this.element.className = "hand-label";
    this.element.setAttribute("aria-live", "polite");
    this.element.hidden = true;
    parent.append(this.element);
  }

  /** @param {number} x @param {number} y pixels of the page @param {Vec3} velocity */
  show(x, y, velocity) {
    this.element.hidden = false;
    place(this.element, x, y);
    const text = `speed ${short(length(velocity))}`;
    if (this.element.textContent !== text) this.element.textContent = text;
  }

  hide() {
    this.element.hidden = true;
  }
}

/** @param {HTMLElement} element @param {number} x @param {number} y */
function place(element, x, y) {
  element.style.setProperty("transform", `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`);
}

export class Handle {
  /**
   * @param {HTMLElement} parent @param {HTMLCanvasElement} canvas @param {Camera} camera
   * @param {(velocity: Vec3) => void} push told when it is let go
   */
  constructor(parent, canvas, camera, push) {
    this.canvas = canvas;
    this.camera = camera;
    this.push = push;
    this.time = 1; // simulated time of an arrow
    this.fullSpeed = 1;
    this.label = new Label(parent);
    /** Where and how fast the sphere is. @type {Ball | null} */
    this.ball = null;
    /** Being dragged: pixels from the pointer to the tip, and the tip that was taken. */
    /** @type {{dx: number, dy: number, tip: Vec3, pointer: number} | null} */ this.drag = null;
    /** What is wanted, until the simulation has it. @type {Vec3 | null} */ this.wanted = null;
    this.epoch = -1; // of the motion in which it was wanted
    this.asked = 0; // when, in milliseconds
    this.element = document.createElement("button");
    this.element.type = "button";
    this.element.className = "hand-handle";
    this.element.setAttribute(
      "aria-label",
      "Velocity of the selected sphere: drag it, or use the arrow keys",
    );
    this.element.title = "Drag the velocity";
    this.element.hidden = true;
    parent.append(this.element);
    this.#listen();
  }

  /** Of the sphere, or what it is going to be. @returns {Vec3} */
  get velocity() {
    return this.wanted ?? this.ball?.v ?? [0, 0, 0];
  }

  /** From the sphere's surface to the tip. @returns {{from: Vec3, to: Vec3}} */
  get arrow() {
    const { x, radius } = this.ball ?? { x: /** @type {Vec3} */ ([0, 0, 0]), radius: 0 };
    return arrowEnds(x, radius, this.velocity, this.time);
  }

  /**
   * The sphere to hold, or null. True if the arrow looks different now.
   * @param {Ball | null} ball @param {number} epoch
   */
  hold(ball, epoch) {
    const shown = this.ball !== null;
    this.ball = ball;
    if (ball === null) this.cancel();
    else if (this.drag === null) {
      const late = performance.now() - this.asked > PATIENCE;
      if (epoch !== this.epoch || late) this.wanted = null;
      this.epoch = epoch;
    }
    this.#draw();
    return shown !== (ball !== null);
  }

  /** Leave the velocity as it is. */
  cancel() {
    if (this.drag !== null && this.element.hasPointerCapture(this.drag.pointer)) {
      this.element.releasePointerCapture(this.drag.pointer);
    }
    const dragged = this.drag !== null;
    this.drag = this.wanted = null;
    this.label.hide();
    return dragged;
  }

  /** Where the viewport's pixels begin on the page. */
  get #corner() {
    const { left, top } = this.canvas.getBoundingClientRect();
    return { x: left + (this.ball?.viewport.x ?? 0), y: top + (this.ball?.viewport.y ?? 0) };
  }

  #draw() {
    const { ball, element } = this;
    const seen = ball === null ? null : this.camera.project(this.arrow.to);
    element.hidden = seen === null || seen.depth <= 0;
    if (ball === null || seen === null || element.hidden) return;
    const { width, height } = ball.viewport;
    const corner = this.#corner;
    const x = corner.x + Math.min(width - EDGE, Math.max(EDGE, seen.x));
    const y = corner.y + Math.min(height - EDGE, Math.max(EDGE, seen.y));
    place(element, x, y);
    if (this.drag !== null || element.matches(":focus-visible")) {
      this.label.show(x, y, this.velocity);
    } else this.label.hide();
  }

  #listen() {
    const { element } = this;
    element.addEventListener("pointerdown", (event) => {
      if (this.ball === null || event.button !== 0) return;
      const tip = this.arrow.to;
      const seen = this.camera.project(tip);
      const corner = this.#corner;
      element.setPointerCapture(event.pointerId);
      this.drag = {
        dx: corner.x + seen.x - event.clientX,
        dy: corner.y + seen.y - event.clientY,
        tip,
        pointer: event.pointerId,
      };
    });
    element.addEventListener("pointermove", (event) => {
      if (this.drag === null || this.ball === null) return;
      const { dx, dy, tip } = this.drag;
      const corner = this.#corner;
      // In the plane through the tip that faces the eye.
      const [x, y] = [event.clientX + dx - corner.x, event.clientY + dy - corner.y];
      const end = this.camera.onPlane(x, y, tip);
      this.wanted = velocityTo(this.ball.x, this.ball.radius, end, this.time);
    });
    element.addEventListener("pointerup", () => {
      if (this.drag === null) return;
      this.drag = null;
      if (this.wanted !== null) this.#ask(this.wanted);
    });
    element.addEventListener("pointercancel", () => this.cancel());
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const { right, up } = this.camera.axes;
    const way = {
      ArrowLeft: scale(right, -1),
      ArrowRight: right,
      ArrowUp: up,
      ArrowDown: scale(up, -1),
    }[event.key];
    if (way === undefined || this.ball === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.#ask(add(this.velocity, scale(way, KEY * this.fullSpeed)));
  }

  /** @param {Vec3} velocity */
  #ask(velocity) {
    this.wanted = velocity;
    this.asked = performance.now();
    this.push(velocity);
  }
}
