// A sketch's frames on the page's side, the order in which shapes are drawn, and the camera.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { decodeSketch } = await import(`${folder}sketch_protocol.js`);
const { Order } = await import(`${folder}sketch_order.js`);
const { SketchCamera } = await import(`${folder}sketch_camera.js`);
const exchange = process.env.CAROM_EXCHANGE;
const read = () => {
  const bytes = readFileSync(`${exchange}/sketch.bin`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const expected = JSON.parse(readFileSync(`${exchange}/sketch.json`, "utf8"));

test("a frame of the server", () => {
  const { kind, frame } = decodeSketch(read());
  assert.equal(kind, "frame");
  for (const [name, value] of Object.entries(expected.frame)) {
    assert.deepEqual(frame[name], value, name);
  }
  expected.shapes.forEach((shape, i) => {
    assert.deepEqual([...frame.numbers.subarray(16 * i, 16 * i + 12)], shape.matrix);
    const word = (k) => frame.words[16 * i + k];
    assert.deepEqual([word(12), word(13)], [shape.fill, shape.stroke]);
    assert.equal(frame.numbers[16 * i + 14], shape.weight);
    assert.deepEqual([word(15) & 0xffff, word(15) >>> 16], [shape.kind, shape.detail]);
  });
});

test("what is cut short, foreign or of another version is refused", () => {
  assert.throws(() => decodeSketch(read().slice(0, -4)), /a sketch of 4 shapes has/);
  assert.throws(() => decodeSketch(new ArrayBuffer(8)), /no message of carom/);
  assert.throws(() => decodeSketch(new ArrayBuffer(200)), /no message of carom/);
  const version = read();
  new DataView(version).setUint16(4, 99, true);
  assert.throws(() => decodeSketch(version), /version 99/);
  const kind = read();
  new DataView(kind).setUint16(6, 1, true);
  assert.throws(() => decodeSketch(kind), /kind 1 is no sketch/);
});

test("solid things come first, then what is seen through from far to near", () => {
  const { frame } = decodeSketch(read());
  const { view } = new SketchCamera().matrices(frame);
  const order = new Order();
  const runs = order.arrange(frame, view);
  // The sheet: a wire sphere at z = -300, a filled one at 0, a wire box at 100, a line at 200.
  assert.deepEqual(
    runs.map((run) => [run.kind, run.solid, run.count]),
    [
      ["spheres", true, 1],
      ["spheres", false, 2], // far half, near half
      ["lines", false, 13], // twelve edges and the line
    ],
  );
  const z = (item) => order.numbers[16 * item + 11];
  assert.deepEqual([z(0), z(1), z(2)], [0, -300, -300]);
  assert.deepEqual([order.words[16 + 15] & 0xffff, order.words[32 + 15] & 0xffff], [2, 1]);
  assert.equal(z(order.count - 1), 200);
});

test("the edges of a box are its edges", () => {
  const { frame } = decodeSketch(read());
  const order = new Order();
  order.arrange(frame, new SketchCamera().matrices(frame).view);
  const corners = new Map();
  for (let item = 3; item < 15; item++) {
    const m = order.numbers.subarray(16 * item, 16 * item + 12);
    const ends = [
      [m[9], m[10], m[11]],
      [m[9] + m[0], m[10] + m[1], m[11] + m[2]],
    ];
    for (const end of ends) {
      const key = end.map((x) => Math.round(x)).join();
      corners.set(key, (corners.get(key) ?? 0) + 1);
    }
  }
  // Eight corners of a cube of side 40 at (400, 300, 100), three edges each.
  assert.equal(corners.size, 8);
  for (const [key, edges] of corners) {
    assert.equal(edges, 3, key);
    const [x, y, z] = key.split(",").map(Number);
    assert.deepEqual([Math.abs(x - 400), Math.abs(y - 300), Math.abs(z - 100)], [20, 20, 20]);
  }
});

test("the camera stands where Processing's does", () => {
  const sheet = { width: 800, height: 600, n: 0, numbers: [], words: [] };
  const { view, projection } = new SketchCamera().matrices(sheet);
  const through = ([x, y, z]) => {
    const row = (m, k, p) => m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k] * p[3];
    const eye = [0, 1, 2, 3].map((k) => row(view, k, [x, y, z, 1]));
    const clip = [0, 1, 2, 3].map((k) => row(projection, k, eye));
    return [400 * (1 + clip[0] / clip[3]), 300 * (1 - clip[1] / clip[3])];
  };
  const near = (got, wanted) => got.forEach((x, k) => assert.ok(Math.abs(x - wanted[k]) < 0.01));
  // On the sheet itself one unit is one pixel, y downwards.
  near(through([0, 0, 0]), [0, 0]);
  near(through([800, 600, 0]), [800, 600]);
  near(through([123, 456, 0]), [123, 456]);
  // Twice as far from the eye things are half as large.
  const away = 300 / Math.tan(Math.PI / 6);
  near(through([800, 600, -away]), [600, 450]);
});
