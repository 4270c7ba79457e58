/**
 * Strength and direction of gravity. The direction is two angles: tilt away from straight down,
 * and heading around the vertical; down is where it was when the scene began.
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {{up: Vec3, forward: Vec3, right: Vec3}} Frame
 */
import { add, dot, length, scale } from "./matrix.js";

const DEGREE = Math.PI / 180;

/** Buttons: name, glyph, tilt and heading in degrees. @type {[string, string, number, number][]} */
export const DIRECTIONS = [
  ["down", "↓", 0, 0],
  ["up", "↑", 180, 0],
  ["left", "←", 90, 180],
  ["right", "→", 90, 0],
  ["away", "⊗", 90, 90],
  ["towards you", "⊙", 90, 270],
];

/** @param {Frame} frame @param {number} tilt @param {number} heading degrees @returns {Vec3} a unit vector */
export function direction({ up, forward, right }, tilt, heading) {
  const [flat, fall] = [Math.sin(tilt * DEGREE), Math.cos(tilt * DEGREE)];
  const level = add(
    scale(right, flat * Math.cos(heading * DEGREE)),
    scale(forward, flat * Math.sin(heading * DEGREE)),
  );
  const sum = add(scale(up, -fall), level);
  // Right angles are meant exactly: no gravity of 6e-17 along an axis that cannot have any.
  return /** @type {Vec3} */ (sum.map((part) => (Math.abs(part) < 1e-15 ? 0 : part)));
}

/** Strength and angles of a vector. @param {Frame} frame @param {Vec3} gravity */
export function angles({ up, forward, right }, gravity) {
  const strength = length(gravity);
  if (strength === 0) return { strength: 0, tilt: 0, heading: 0 };
  const cosine = -dot(gravity, up) / strength;
  const [x, y] = [dot(gravity, right), dot(gravity, forward)];
  const level = Math.hypot(x, y) / strength;
  const tilt = Math.atan2(level, cosine) / DEGREE;
  const heading = level < 1e-9 ? 0 : (Math.atan2(y, x) / DEGREE + 360) % 360;
  return { strength, tilt: round(tilt), heading: round(heading) };
}

/** @param {number} angle */
const round = (angle) => Math.round(angle * 10) / 10;

/** May gravity have this direction in a world with these periods? @param {Vec3} unit @param {number[]} period */
export const allowed = (unit, period) => period.every((length_, k) => !(length_ > 0) || unit[k] === 0);
