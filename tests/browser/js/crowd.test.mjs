// Light left in a crowd, against what can be said of it without the sweep.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { Crowd, cover } = await import(`${folder}crowd.js`);

/** Spheres of one radius at even places in a cube around the origin. */
function lattice(side, half, radius) {
  const at = (k) => -half + ((k + 0.5) * 2 * half) / side;
  const position = [];
  for (let i = 0; i < side; i++) {
    for (let j = 0; j < side; j++) for (let k = 0; k < side; k++) position.push(at(i), at(j), at(k));
  }
  const n = position.length / 3;
  return { position: Float32Array.from(position), radius: new Float32Array(n).fill(radius) };
}

const cell = (crowd, i, j, k) => crowd.bytes[i + crowd.cells[0] * (j + crowd.cells[1] * k)];

test("an empty room is all light", () => {
  const crowd = new Crowd([-1, -1, -1], [1, 1, 1], 0.1);
  crowd.fill(new Float32Array(0), new Float32Array(0), 2, 1);
  assert.ok(crowd.bytes.every((value) => value === 255));
});

test("the middle of a crowd is darker than its borders, the top lighter than the bottom", () => {
  const { position, radius } = lattice(12, 6, 0.5);
  const crowd = new Crowd([-6, -6, -6], [6, 6, 6], 0.5);
  crowd.fill(position, radius, 2, 1);
  const [n] = crowd.cells;
  const mid = n >> 1;
  const [middle, top] = [cell(crowd, mid, mid, mid), cell(crowd, mid, mid, n - 1)];
  const [bottom, side] = [cell(crowd, mid, mid, 0), cell(crowd, 0, mid, mid)];
  assert.ok(middle < side && middle < top && middle < bottom, `${[middle, side, top, bottom]}`);
  assert.ok(top > bottom + 20, `${[top, bottom]}`);
});

test("the sky may be on the lower end of any axis", () => {
  const { position, radius } = lattice(12, 6, 0.5);
  const crowd = new Crowd([-6, -6, -6], [6, 6, 6], 0.5);
  crowd.fill(position, radius, 1, -1);
  const [n] = crowd.cells;
  const mid = n >> 1;
  assert.ok(cell(crowd, mid, 0, mid) > cell(crowd, mid, n - 1, mid) + 20);
});

test("what is hidden is the area of the spheres, wherever they stand", () => {
  const crowd = new Crowd([0, 0, 0], [8, 4, 2], 0.3);
  const position = Float32Array.of(0.1, 3.9, 1, 4, 2, 1.99, 7, 1, 0.5, 90, -90, 90);
  const radius = Float32Array.of(0.3, 0.2, 0.5, 0.1);
  crowd.fill(position, radius, 2, 1);
  const volume = crowd.size.reduce((product, s, k) => (product * s) / crowd.cells[k], 1);
  const area = crowd.hidden.reduce((sum, value) => sum + value, 0) * volume;
  const expected = radius.reduce((sum, r) => sum + Math.PI * r * r, 0);
  assert.ok(Math.abs(area - expected) < 1e-4 * expected, `${area} is not ${expected}`);
});

test("cover counts the spheres on a ray's way", () => {
  const radius = new Float32Array(100).fill(1);
  assert.ok(Math.abs(cover(radius, [10, 10, 5]) - Math.PI) < 1e-4);
});
