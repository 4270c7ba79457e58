/**
 * Vectors and 4 × 4 matrices, column by column as WebGL takes them.
 * @typedef {[number, number, number]} Vec3
 */

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/** @param {Vec3} a @param {number} s @returns {Vec3} */
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];

/** @param {Vec3} a @param {Vec3} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** @param {Vec3} a */
export const length = (a) => Math.hypot(...a);

/** @param {Vec3} a @returns {Vec3} */
export const normalize = (a) => scale(a, 1 / (length(a) || 1));

/** Any unit vector across `a`. @param {Vec3} a @returns {Vec3} */
export function across(a) {
  return normalize(cross(a, Math.abs(a[2]) < 0.9 * length(a) ? [0, 0, 1] : [1, 0, 0]));
}

/** A direction after a 4 × 4 matrix. @param {ArrayLike<number>} m @param {Vec3} a @returns {Vec3} */
export const direction = (m, [x, y, z]) => [
  m[0] * x + m[4] * y + m[8] * z,
  m[1] * x + m[5] * y + m[9] * z,
  m[2] * x + m[6] * y + m[10] * z,
];

/**
 * World to eye: x to the right, y up, looking along −z.
 * @param {Vec3} eye @param {Vec3} right @param {Vec3} up @param {Vec3} back unit vectors
 */
export function viewMatrix(eye, right, up, back) {
  // prettier-ignore
  return new Float32Array([
    right[0], up[0], back[0], 0,
    right[1], up[1], back[1], 0,
    right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ]);
}

/**
 * Perspective whose axis hits the picture at (cx, cy), in units of half its width and height.
 * @param {number} tanX @param {number} tanY half the picture's size at distance 1
 * @param {number} near @param {number} far @param {number} cx @param {number} cy
 */
export function perspective(tanX, tanY, near, far, cx, cy) {
  const depth = 1 / (near - far);
  // prettier-ignore
  return new Float32Array([
    1 / tanX, 0, 0, 0,
    0, 1 / tanY, 0, 0,
    -cx, -cy, (near + far) * depth, -1,
    0, 0, 2 * near * far * depth, 0,
  ]);
}
