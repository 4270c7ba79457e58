/**
 * A camera on a sphere around its target.
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {{left: number, right: number, top: number, bottom: number}} Insets
 */
import {
  add,
  cross,
  dot,
  length,
  normalize,
  perspective,
  scale,
  sub,
  viewMatrix,
} from "./matrix.js";

const HALF_ANGLE = Math.tan((17 * Math.PI) / 180); // half the picture's height at distance 1
const STEEPEST = 1.54; // radians; at a right angle left and right lose their meaning

export class Camera {
  constructor() {
    /** @type {Vec3} */ this.target = [0, 0, 0];
    /** @type {Vec3} */ this.up = [0, 0, 1];
    this.distance = 10;
    this.azimuth = 0; // about `up`
    this.height = 0.3; // radians above the horizon
    this.size = { width: 1, height: 1 };
    /** Parts of the picture, in pixels of the page, that panels cover. @type {Insets} */
    this.insets = { left: 0, right: 0, top: 0, bottom: 0 };
    this.reach = 10; // radius around the target of everything there is to see
    this.version = 0; // counts changes
    this.moved = false; // by hand, since it last looked at everything
  }

  /** Forward and rightward horizontal axes at azimuth 0. @returns {[Vec3, Vec3]} */
  get compass() {
    const forward = /** @type {Vec3} */ (Math.abs(this.up[1]) > 0.9 ? [0, 0, -1] : [0, 1, 0]);
    const right = normalize(cross(forward, this.up));
    return [cross(this.up, right), right];
  }

  /** Unit vectors right, up and back (towards the eye). */
  get axes() {
    const [forward, side] = this.compass;
    const flat = add(
      scale(forward, -Math.cos(this.azimuth)),
      scale(side, Math.sin(this.azimuth)),
    );
    const back = normalize(
      add(scale(flat, Math.cos(this.height)), scale(this.up, Math.sin(this.height))),
    );
    const right = normalize(cross(this.up, back));
    return { right, up: cross(back, right), back };
  }

  /** @returns {Vec3} */
  get eye() {
    return add(this.target, scale(this.axes.back, this.distance));
  }

  /** Half the picture's width and height at distance 1. */
  get tangents() {
    return { x: (HALF_ANGLE * this.size.width) / this.size.height, y: HALF_ANGLE };
  }

  get view() {
    const { right, up, back } = this.axes;
    return viewMatrix(this.eye, right, up, back);
  }

  get projection() {
    const { left, right, top, bottom } = this.insets;
    const far = this.distance + 4 * this.reach;
    const near = Math.max(this.distance - 4 * this.reach, far / 2000);
    const { x, y } = this.tangents;
    const cx = (left - right) / this.size.width;
    return perspective(x, y, near, far, cx, (bottom - top) / this.size.height);
  }

  /** @param {number} width @param {number} height @param {Insets} insets */
  resize(width, height, insets) {
    this.size = { width, height };
    this.insets = insets;
    this.version++;
  }

  /** Turn by angles in radians. @param {number} right @param {number} up */
  turn(right, up) {
    this.moved = true;
    this.azimuth -= right;
    this.height = Math.min(STEEPEST, Math.max(-STEEPEST, this.height + up));
    this.version++;
  }

  /** Move closer (factor < 1) or away. @param {number} factor */
  zoom(factor) {
    this.moved = true;
    const wanted = this.distance * factor;
    this.distance = Math.min(50 * this.reach, Math.max(0.02 * this.reach, wanted));
    this.version++;
  }

  /** Move what is seen by pixels of the page. @param {number} x @param {number} y downwards */
  pan(x, y) {
    this.moved = true;
    const { right, up } = this.axes;
    const pixel = (2 * HALF_ANGLE * this.distance) / this.size.height;
    this.target = add(this.target, add(scale(right, -x * pixel), scale(up, y * pixel)));
    this.version++;
  }

  /** Look from a place at another. @param {Vec3} position @param {Vec3} target */
  look(position, target) {
    const line = sub(position, target);
    this.target = target;
    this.distance = length(line);
    const [forward, side] = this.compass;
    this.height = Math.asin(Math.max(-1, Math.min(1, dot(normalize(line), this.up))));
    this.height = Math.min(STEEPEST, Math.max(-STEEPEST, this.height));
    this.azimuth = Math.atan2(dot(line, side), -dot(line, forward));
    this.version++;
  }

  /**
   * Take the distance from which balls around points just fit between the panels.
   * @param {{center: Vec3, points: Vec3[], margin: number}} bounds
   */
  fit({ center, points, margin }) {
    this.moved = false;
    const { right, up, back } = this.axes;
    const { left, right: rightInset, top, bottom } = this.insets;
    const free = 0.92;
    const tanX = this.tangents.x * free * Math.max(0.2, 1 - (left + rightInset) / this.size.width);
    const tanY = this.tangents.y * free * Math.max(0.2, 1 - (top + bottom) / this.size.height);
    this.target = center;
    this.distance = 0;
    this.reach = margin;
    for (const point of points) {
      const p = sub(point, center);
      // The cone of half angle a around a ball of radius m touches it at distance m/sin a.
      const x = (Math.abs(dot(p, right)) + margin * Math.hypot(1, tanX)) / tanX;
      const y = (Math.abs(dot(p, up)) + margin * Math.hypot(1, tanY)) / tanY;
      this.distance = Math.max(this.distance, dot(p, back) + Math.max(x, y));
      this.reach = Math.max(this.reach, length(p) + margin);
    }
    this.version++;
  }

  /** Point away from gravity if there is any. @param {Vec3} gravity */
  stand(gravity) {
    this.up = length(gravity) > 0 ? normalize(scale(gravity, -1)) : [0, 0, 1];
    const axis = this.up.findIndex((part) => Math.abs(part) > 1 - 1e-9);
    if (axis >= 0) this.up = /** @type {Vec3} */ (this.up.map((part) => Math.round(part)));
  }
}
