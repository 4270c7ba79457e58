// Numbers, colours, camera and walls.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { count, multiple, scientific, short } = await import(`${folder}numbers.js`);
const { saturated, unpack } = await import(`${folder}colors.js`);
const { Camera } = await import(`${folder}camera.js`);
const { buildWalls } = await import(`${folder}walls.js`);

test("numbers", () => {
  assert.equal(count(3141592), "3\u202f141\u202f592");
  assert.equal(count(12), "12");
  assert.equal(scientific(-3.2e-15), "3 × 10⁻¹⁵");
  assert.equal(scientific(0), "0");
  assert.equal(short(0.5), "0.5");
  assert.equal(short(123.456, 4), "123.5");
  assert.equal(short(-1500, 4), "−1\u202f500");
  assert.equal(short(1.5e-7), "1.5 × 10⁻⁷");
  assert.equal(short(NaN), "–");
  assert.equal(multiple(0.001), "0.001×");
  assert.equal(multiple(100), "100×");
});

test("saturation leaves hue and brightness", () => {
  const own = unpack(0xff0080);
  assert.deepEqual(saturated(own, 0), [1, 1, 1]);
  assert.deepEqual(saturated(own, 1), own);
  assert.deepEqual(saturated([0.5, 0.5, 0.5], 1), [0.5, 0, 0]); // grey has hue 0, as in Processing
});

const project = (camera, [x, y, z]) => {
  const apply = (m, v) => [0, 1, 2, 3].map((r) => v.reduce((sum, p, c) => sum + m[4 * c + r] * p, 0));
  const [a, b, c, w] = apply(camera.projection, apply(camera.view, [x, y, z, 1]));
  return [a / w, b / w, c / w];
};

test("the camera sees its target in the middle of what panels leave free", () => {
  const camera = new Camera();
  camera.resize(1000, 500, { left: 0, right: 200, top: 0, bottom: 100 });
  camera.look([3, -7, 4], [1, 2, 3]);
  camera.eye.forEach((part, k) => assert.ok(Math.abs(part - [3, -7, 4][k]) < 1e-12));
  const [x, y] = project(camera, [1, 2, 3]);
  assert.ok(Math.abs(x + 0.2) < 1e-6 && Math.abs(y - 0.2) < 1e-6);
});

test("straight from above or below nothing is turned round", () => {
  for (const z of [30, -30]) {
    for (const x of [0, -0, 1e-17, -1e-17]) {
      for (const y of [0, -0, 1e-17, -1e-17]) {
        const camera = new Camera();
        camera.look([x, y, z], [0, 0, 0]);
        camera.axes.right.forEach((part, k) => assert.ok(Math.abs(part - [1, 0, 0][k]) < 1e-9));
      }
    }
  }
});

test("it fits balls tightly, from every side, in tall and wide windows", () => {
  for (const [width, height] of [[1280, 720], [390, 844]]) {
    for (const azimuth of [-2, 0, 0.5, 3]) {
      const camera = new Camera();
      camera.azimuth = azimuth;
      camera.resize(width, height, { left: 0, right: 100, top: 0, bottom: 50 });
      const points = [];
      for (let bits = 0; bits < 8; bits++) points.push([0, 1, 2].map((k) => ((bits >> k) & 1) - 0.5));
      camera.fit({ center: [0, 0, 0], points, margin: 0 });
      const seen = points.map((point) => project(camera, point));
      const most = Math.max(
        ...seen.map(([x]) => Math.abs(x + 100 / width) / (1 - 100 / width)),
        ...seen.map(([, y]) => Math.abs(y - 50 / height) / (1 - 50 / height)),
      );
      assert.ok(Math.abs(most - 0.92) < 1e-5, `${most}`);
      assert.ok(seen.every(([, , z]) => Math.abs(z) < 1));
    }
  }
});

test("up is where gravity does not point", () => {
  const camera = new Camera();
  camera.stand([0, -3, 0]);
  assert.deepEqual(camera.up.map(Math.abs), [0, 1, 0]);
  for (const gravity of [[0, 0, 0], [0, 0, -1], [5, 0, 0], [0, 2, 0], [1, 1, 1]]) {
    camera.stand(gravity);
    const { right, up, back } = camera.axes;
    for (const axis of [right, up, back]) assert.ok(Math.abs(Math.hypot(...axis) - 1) < 1e-12);
  }
});

const about = (walls, period = [0, 0, 0]) => ({ walls, period, low: [-1, -1, -1], high: [1, 1, 1] });
const plane = (normal, offset) => ({ kind: 0, normal, offset });
const box = [0, 1, 2].flatMap((k) =>
  [1, -1].map((sign) => plane([0, 1, 2].map((j) => (j === k ? sign : 0)), -2 - k)),
);

test("a box has six faces and twelve unbroken edges", () => {
  const { faces, edges, bounds } = buildWalls(about(box));
  assert.equal(faces.length, 6);
  assert.equal(edges.length, 12);
  assert.ok(edges.every((edge) => edge.dash === 0));
  assert.deepEqual(bounds.points.at(-1), [2, 3, 4]);
});

test("a periodic box has dashed edges and no faces; a slab has both", () => {
  const cube = buildWalls(about([], [4, 4, 4]));
  assert.equal(cube.faces.length, 0);
  assert.ok(cube.edges.length === 12 && cube.edges.every((edge) => edge.dash > 0));
  const slab = buildWalls(about(box.slice(4), [4, 4, 0]));
  assert.equal(slab.faces.length, 2);
  assert.equal(slab.edges.filter((edge) => edge.dash === 0).length, 8);
});

test("shells, tubes and single planes", () => {
  assert.deepEqual(buildWalls(about([{ kind: 1, normal: [0, 0, 0], offset: 5 }])).shells, [5]);
  const tube = [{ kind: 2, normal: [0, 0, 0], offset: 3 }, ...box.slice(4)];
  const { edges } = buildWalls(about(tube));
  assert.ok(edges.every(({ from }) => Math.abs(Math.hypot(from[0], from[1]) - 3) < 1e-12));
  const [floor] = buildWalls(about([plane([0, 0, 1], -1)])).faces;
  assert.ok(floor.fade > 0 && floor.center[2] === -1);
});
