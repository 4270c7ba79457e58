/**
 * How much light is left inside a crowd of spheres: a coarse grid of what they hide, swept from
 * six sides. It makes the middle of a dense fluid darker, smoothly, as no shadow map could.
 * Pure arithmetic, without WebGL.
 */

const MOST = 24; // cells along an axis
const CELL = 3; // typical radii
/** Shares of the light from the sky, the ground, and the four sides. */
const FROM = { above: 0.4, below: 0.08, side: 0.13 };
const GENTLE = 0.7; // power of the light, for its many reflections
const LEAK = 0.55; // of what hides light; the rest finds its way round

/** How many spheres a ray meets on its way, about. @param {Float32Array} radius @param {number[]} size of the room */
export function cover(radius, size) {
  let area = 0;
  for (const r of radius) area += Math.PI * r * r;
  const [a, b, c] = size;
  return area / Math.max(a * b, b * c, c * a, 1e-30);
}

export class Crowd {
  /** @param {number[]} low @param {number[]} high corners of the room @param {number} radius the typical one */
  constructor(low, high, radius) {
    this.low = low;
    this.size = [0, 1, 2].map((k) => Math.max(high[k] - low[k], 1e-9));
    this.cells = this.size.map((s) => Math.min(MOST, Math.max(2, Math.round(s / (CELL * radius)))));
    const [nx, ny, nz] = this.cells;
    this.hidden = new Float32Array(nx * ny * nz); // area per volume
    this.light = new Float32Array(nx * ny * nz);
    this.bytes = new Uint8Array(nx * ny * nz); // what the GPU gets
  }

  /**
   * @param {Float32Array} position @param {Float32Array} radius
   * @param {number} axis along which the sky is @param {number} sign on its upper (1) or lower (-1) end
   */
  fill(position, radius, axis, sign) {
    this.#spread(position, radius);
    this.light.fill(0);
    for (let k = 0; k < 3; k++) {
      this.#sweep(k, 1, k === axis ? (sign > 0 ? FROM.below : FROM.above) : FROM.side);
      this.#sweep(k, -1, k === axis ? (sign > 0 ? FROM.above : FROM.below) : FROM.side);
    }
    // The best-lit place counts as fully lit, and what is near it too.
    const most = this.light.reduce((a, b) => Math.max(a, b), 1e-9);
    for (let c = 0; c < this.light.length; c++) {
      this.bytes[c] = Math.min(255, 1.15 * 255 * (this.light[c] / most) ** GENTLE);
    }
  }

  /** @param {Float32Array} position @param {Float32Array} radius */
  #spread(position, radius) {
    const { hidden, cells, low, size } = this;
    hidden.fill(0);
    const per = size.map((s, k) => cells[k] / s);
    const volume = 1 / (per[0] * per[1] * per[2]);
    const [nx, ny] = cells;
    // Along an axis, in cells, and never so far out that the next cell would be missing.
    const along = (/** @type {number} */ i, /** @type {number} */ k) =>
      Math.min(cells[k] - 1.001, Math.max(0, (position[3 * i + k] - low[k]) * per[k] - 0.5));
    for (let i = 0; i < radius.length; i++) {
      const area = (Math.PI * radius[i] * radius[i]) / volume;
      const [x, y, z] = [along(i, 0), along(i, 1), along(i, 2)];
      const [a, b, c] = [Math.floor(x), Math.floor(y), Math.floor(z)];
      const [right, far, high] = [x - a, y - b, z - c];
      // Shared out among the eight cells around it.
      for (let k = 0; k < 4; k++) {
        const row = a + nx * (b + (k & 1) + ny * (c + (k >> 1)));
        const part = area * (k & 1 ? far : 1 - far) * (k >> 1 ? high : 1 - high);
        hidden[row] += part * (1 - right);
        hidden[row + 1] += part * right;
      }
    }
  }

  /**
   * Add the light that comes along an axis, from its low end (1) or its high end (-1).
   * @param {number} axis @param {1 | -1} way @param {number} share of all light
   */
  #sweep(axis, way, share) {
    const { hidden, light, cells, size } = this;
    const [nx, ny] = cells;
    const stride = [1, nx, nx * ny];
    const [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
    const step = (LEAK * size[axis]) / cells[axis];
    for (let i = 0; i < cells[a]; i++) {
      for (let j = 0; j < cells[b]; j++) {
        let depth = 0;
        for (let k = 0; k < cells[axis]; k++) {
          const along = way > 0 ? k : cells[axis] - 1 - k;
          const c = i * stride[a] + j * stride[b] + along * stride[axis];
          depth += 0.5 * step * hidden[c]; // half of its own cell lies before the middle
          light[c] += share * Math.exp(-depth);
          depth += 0.5 * step * hidden[c];
        }
      }
    }
  }
}
