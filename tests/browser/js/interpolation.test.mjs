// Exact motion between keyframes, against flights and collisions computed here.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { motion, nearestImage, placeOf, wrap } = await import(`${folder}interpolation.js`);

const OPEN = [0, 0, 0];
const close = (a, b, error = 1e-12) =>
  a.forEach((value, k) => assert.ok(Math.abs(value - b[k]) <= error, `${a} is not ${b}`));
const along = (x, v, g, s) => x.map((value, k) => value + v[k] * s + 0.5 * g[k] * s * s);
const faster = (v, g, s) => v.map((value, k) => value + g[k] * s);

test("free flight under gravity is exact at every moment", () => {
  const [x, v, g, h] = [[1, 2, 3], [0.5, -1, 2], [0, 0, -9.8], 0.4];
  const a = { x, v, count: 9 };
  const b = { x: along(x, v, g, h), v: faster(v, g, h), count: 9 };
  for (const s of [0, 0.1, 0.25, 0.4]) {
    const { x: place, v: velocity, v2 } = motion(a, b, s, h, g, OPEN);
    close(place, along(x, v, g, s));
    close(velocity, faster(v, g, s));
    close([v2], [faster(v, g, s).reduce((sum, part) => sum + part * part, 0)]);
  }
});

test("one collision is exact before and after, wherever in the frame it happens", () => {
  const [x, v, w, g, h] = [[0, 0, 1], [1, 2, -1], [-1, 2, 3], [0, 0, -5], 0.5];
  for (const when of [0.001, 0.2, 0.499]) {
    const kick = faster(v, g, when).map((value, k) => value + w[k] - v[k]);
    const hit = along(x, v, g, when);
    const a = { x, v, count: 0x7fffffff };
    const end = along(hit, kick, g, h - when);
    const b = { x: end, v: faster(kick, g, h - when), count: 0 }; // one more, in 31 bits
    for (const s of [0, 0.1, 0.2, 0.3, 0.5]) {
      const right = s < when ? along(x, v, g, s) : along(hit, kick, g, s - when);
      const got = motion(a, b, s, h, g, OPEN);
      close(got.x, right, 1e-12);
      close(got.v, s < when ? faster(v, g, s) : faster(kick, g, s - when), 1e-12);
    }
  }
});

test("one collision across the border of a periodic box", () => {
  const [h, period, g] = [1, [10, 0, 10], OPEN];
  const x = [4.8, 0, -4.9];
  const [v, w] = [[1.5, 0.5, -2], [2, -0.5, 3]];
  const hit = along(x, v, g, 0.3);
  const b = { x: wrap(along(hit, w, g, 0.7), period), v: w, count: 1 };
  for (const s of [0, 0.2, 0.3, 0.31, 0.8, 1]) {
    const right = s < 0.3 ? along(x, v, g, s) : along(hit, w, g, s - 0.3);
    close(motion({ x, v, count: 0 }, b, s, h, g, period).x, wrap(right, period), 1e-12);
  }
});

test("several collisions: a straight line that stays in the box, energies mixed", () => {
  const a = { x: [0.9, 0, 0], v: [3, 0, 0], count: 3 };
  const b = { x: [-0.9, 0, 0], v: [0, 1, 0], count: 5 };
  for (let s = 0; s <= 1; s += 0.125) {
    const { x, v, v2 } = motion(a, b, s, 1, OPEN, OPEN);
    close(x, [0.9 - 1.8 * s, 0, 0]);
    close(v, [3 - 3 * s, s, 0]);
    close([v2], [9 - 8 * s]);
  }
});

test("a resting sphere does not fall, and one that comes to rest goes straight", () => {
  const g = [0, 0, -10];
  const still = { x: [0, 0, 1], v: [2, 0, 0], count: 0x80000004 };
  close(motion(still, { ...still, x: [1, 0, 1] }, 0.25, 0.5, g, OPEN).x, [0.5, 0, 1]);
  const falling = { x: [0, 0, 1.2], v: [0, 0, -1], count: 3 };
  close(motion(falling, still, 0.25, 0.5, g, OPEN).x, [0, 0, 1.1]);
});

test("two keyframes of the same moment show the second", () => {
  const a = { x: [1, 1, 1], v: [0, 0, 0], count: 0 };
  const b = { x: [2, 2, 2], v: [1, 0, 0], count: 0 };
  assert.deepEqual(motion(a, b, 0, 0, OPEN, OPEN), {
    x: [2, 2, 2],
    v: [1, 0, 0],
    v2: 1,
  });
});

test("one sphere of two keyframes, by its number", () => {
  const keyframe = (t, x, v, count) => ({
    t,
    gravity: [0, 0, -2],
    position: Float32Array.of(9, 9, 9, ...x),
    velocity: Float32Array.of(7, 7, 7, ...v),
    counts: Uint32Array.of(1, count),
  });
  const first = keyframe(1, [0, 0, 4], [1, 0, 0], 5);
  const second = keyframe(3, [2, 0, 0], [1, 0, -4], 5);
  const { x, v, v2 } = placeOf(first, second, 2, 1, OPEN);
  close(x, [1, 0, 3]);
  close(v, [1, 0, -2]);
  close([v2], [5]);
  close(placeOf(first, second, 0, 1, OPEN).x, [0, 0, 4]); // never before the first
  close(placeOf(first, second, 9, 1, OPEN).x, [2, 0, 0]);
  const resting = keyframe(3, [2, 0, 4], [1, 0, 0], 0x80000005);
  close(placeOf({ ...resting, t: 1, position: first.position }, resting, 2, 1, OPEN).x, [1, 0, 4]);
});

test("images and wrapping", () => {
  close(nearestImage([-4, 3, 0], [5.5, 3, 99], [10, 0, 10]), [6, 3, 100]);
  close(wrap([5, -5.5, 70], [10, 10, 0]), [-5, 4.5, 70]);
});
