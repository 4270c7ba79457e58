/**
 * A camera on a sphere around its target.
 *
 * Its numbers say where it is going; `lag` says how far it still is from there. Whatever moves
 * it in steps (keys, the wheel, showing everything) leaves a lag that fades within a blink;
 * whatever moves it continuously (fingers, a followed sphere) leaves none.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {{left: number, right: number, top: number, bottom: number}} Insets
 * @typedef {{origin: Vec3, direction: Vec3}} Ray a unit direction
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
const PLUMB = 1e-9; // radians from straight down or up, where there is no direction to look in
const ROUND = 2 * Math.PI;
const GLIDE = 0.07; // seconds in which a lag shrinks to a third
/** @type {{azimuth: number, height: number, zoom: number, target: Vec3}} */
const NO_LAG = { azimuth: 0, height: 0, zoom: 0, target: [0, 0, 0] };
const ARRIVED = 1e-4; // radians, and parts of the distance: less than a pixel

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
    this.follows = false; // somebody moves the target with a sphere
    this.calm = false; // no gliding, for people whom motion disturbs
    /** What is shown minus where it goes. `zoom` is a logarithm. */
    this.lag = NO_LAG;
  }

  /** The place that is in the middle of the picture now. @returns {Vec3} */
  get center() {
    return add(this.target, this.lag.target);
  }

  /** How far from it the eye is now. */
  get away() {
    return this.distance * Math.exp(this.lag.zoom);
  }

  /** Is it still on its way? */
  get gliding() {
    return this.lag !== NO_LAG;
  }

  /** Arrive at once. */
  finish() {
    this.lag = NO_LAG;
    this.version++;
  }

  /** Let time pass for gliding. @param {number} seconds */
  advance(seconds) {
    if (!this.gliding) return;
    const { azimuth, height, zoom, target } = this.lag;
    const left = this.calm ? 0 : Math.exp(-seconds / GLIDE);
    const most = Math.max(
      ...[azimuth, height, zoom].map(Math.abs),
      length(target) / this.distance,
    );
    if (most * left < ARRIVED) return this.finish();
    this.lag = {
      azimuth: azimuth * left,
      height: height * left,
      zoom: zoom * left,
      target: scale(target, left),
    };
    this.version++;
  }

  /** Glide from what is shown now to where `change` puts the camera. @param {() => void} change */
  glide(change) {
    const [target, away] = [this.center, this.away];
    const azimuth = this.azimuth + this.lag.azimuth;
    const height = this.height + this.lag.height;
    change();
    if (this.calm) return this.finish();
    this.lag = {
      // The short way round.
      azimuth: azimuth - this.azimuth - ROUND * Math.round((azimuth - this.azimuth) / ROUND),
      height: height - this.height,
      zoom: Math.log(away / this.distance),
      target: sub(target, this.target),
    };
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
    const azimuth = this.azimuth + this.lag.azimuth;
    const height = this.height + this.lag.height;
    const flat = add(scale(forward, -Math.cos(azimuth)), scale(side, Math.sin(azimuth)));
    const back = normalize(add(scale(flat, Math.cos(height)), scale(this.up, Math.sin(height))));
    const right = normalize(cross(this.up, back));
    return { right, up: cross(back, right), back };
  }

  /** @returns {Vec3} */
  get eye() {
    return add(this.center, scale(this.axes.back, this.away));
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
    const far = this.away + 4 * this.reach;
    const near = Math.max(this.away - 4 * this.reach, far / 2000);
    const { x, y } = this.tangents;
    const cx = (left - right) / this.size.width;
    return perspective(x, y, near, far, cx, (bottom - top) / this.size.height);
  }

  /** Width of a pixel of the page at distance 1. */
  get pixel() {
    return (2 * HALF_ANGLE) / this.size.height;
  }

  /** Pixel, from the viewport's upper left corner, in which the target is seen. */
  get middle() {
    const { left, right, top, bottom } = this.insets;
    const { width, height } = this.size;
    return { x: (width + left - right) / 2, y: (height + top - bottom) / 2 };
  }

  /** What is seen in a pixel of the viewport. @param {number} x @param {number} y downwards @returns {Ray} */
  ray(x, y) {
    const { right, up, back } = this.axes;
    const { middle, pixel } = this;
    const aside = add(scale(right, (x - middle.x) * pixel), scale(up, (middle.y - y) * pixel));
    return { origin: this.eye, direction: normalize(sub(aside, back)) };
  }

  /**
   * Where a place is seen: pixels of the viewport, y downwards. `depth` is its distance along
   * the line of sight, negative behind the eye; `scale` the pixels per unit of length there.
   * @param {Vec3} point
   */
  project(point) {
    const { right, up, back } = this.axes;
    const { middle, pixel } = this;
    const line = sub(point, this.eye);
    const depth = -dot(line, back);
    const size = 1 / (pixel * depth);
    return {
      x: middle.x + dot(line, right) * size,
      y: middle.y - dot(line, up) * size,
      depth,
      scale: size,
    };
  }

  /**
   * Where the line of sight through a pixel cuts the plane through a place that faces the eye.
   * @param {number} x @param {number} y @param {Vec3} place @returns {Vec3}
   */
  onPlane(x, y, place) {
    const { back } = this.axes;
    const { origin, direction } = this.ray(x, y);
    return add(origin, scale(direction, dot(sub(place, origin), back) / dot(direction, back)));
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
    this.follows = false;
    const { right, up } = this.axes;
    const pixel = this.pixel * this.away;
    this.target = add(this.target, add(scale(right, -x * pixel), scale(up, y * pixel)));
    this.version++;
  }

  /** Start to follow something that is at a place now: `carry` must tell where it goes. @param {Vec3} place */
  follow(place) {
    this.glide(() => (this.target = place));
    this.moved = this.follows = true;
    this.version++;
  }

  /** What is followed is here now. @param {Vec3} place */
  carry(place) {
    if (!this.follows || place.every((part, k) => part === this.target[k])) return;
    this.target = place;
    this.version++;
  }

  /** Look from a place at another. @param {Vec3} position @param {Vec3} target */
  look(position, target) {
    this.follows = false;
    const line = sub(position, target);
    this.target = target;
    this.distance = length(line);
    const [forward, side] = this.compass;
    this.height = Math.asin(Math.max(-1, Math.min(1, dot(normalize(line), this.up))));
    this.height = Math.min(STEEPEST, Math.max(-STEEPEST, this.height));
    const [x, y] = [dot(line, side), -dot(line, forward)];
    // Straight down, and nearly so, no direction is left but the sign of a zero.
    this.azimuth = Math.hypot(x, y) > PLUMB * this.distance ? Math.atan2(x, y) : 0;
    this.version++;
  }

  /**
   * Take the distance from which balls around points just fit between the panels.
   * @param {{center: Vec3, points: Vec3[], margin: number}} bounds
   */
  fit({ center, points, margin }) {
    this.moved = this.follows = false;
    this.finish(); // sizes are measured along the axes it will have
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
