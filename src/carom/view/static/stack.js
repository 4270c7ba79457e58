/**
 * The matrix stack of Processing and old OpenGL: the environment moves, not the object.
 *
 *     stack.push();
 *     stack.translate(x, y, z);
 *     drawSphere(stack.top);
 *     stack.pop();
 */

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b a·b, column by column */
export function product(a, b) {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      out[4 * column + row] = sum;
    }
  }
  return out;
}

export class MatrixStack {
  constructor() {
    /** @type {Float32Array} */
    // prettier-ignore
    this.top = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    /** @type {Float32Array[]} */ this.kept = [];
  }

  /** How many matrices were pushed and not yet popped. */
  get depth() {
    return this.kept.length;
  }

  /** Keep the matrix, to come back to with `pop`. */
  push() {
    this.kept.push(this.top.slice());
  }

  /** Come back to the matrix kept last. */
  pop() {
    const top = this.kept.pop();
    if (top === undefined) throw new Error("pop without push: 0 matrices are kept; push one first");
    this.top = top;
  }

  /**
   * Everything drawn from now on goes through this matrix first, then through those before it.
   * @param {ArrayLike<number>} matrix column by column
   */
  multiply(matrix) {
    this.top = product(this.top, matrix);
  }

  /** @param {number} x @param {number} y @param {number} z */
  translate(x, y, z) {
    const m = this.top;
    for (let row = 0; row < 4; row++) {
      m[12 + row] += m[row] * x + m[4 + row] * y + m[8 + row] * z;
    }
  }

  /** @param {number} x @param {number} y @param {number} z */
  scale(x, y = x, z = x) {
    const m = this.top;
    for (let row = 0; row < 4; row++) {
      m[row] *= x;
      m[4 + row] *= y;
      m[8 + row] *= z;
    }
  }

  /**
   * Turn by an angle in radians about an axis, counterclockwise as seen from its tip.
   * @param {number} angle @param {number} x @param {number} y @param {number} z
   */
  rotate(angle, x, y, z) {
    const length = Math.hypot(x, y, z);
    if (!(length > 0)) throw new Error("the axis (0, 0, 0) has no direction; give another");
    const [a, b, c] = [x / length, y / length, z / length];
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const rest = 1 - cos;
    // prettier-ignore
    this.multiply([
      a * a * rest + cos, a * b * rest + c * sin, a * c * rest - b * sin, 0,
      a * b * rest - c * sin, b * b * rest + cos, b * c * rest + a * sin, 0,
      a * c * rest + b * sin, b * c * rest - a * sin, c * c * rest + cos, 0,
      0, 0, 0, 1,
    ]);
  }

  /** Where a point lands. @param {number[]} point @returns {[number, number, number]} */
  apply([x, y, z]) {
    const m = this.top;
    const row = (/** @type {number} */ k) => m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k];
    return [row(0), row(1), row(2)];
  }
}
