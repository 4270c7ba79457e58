// The wire protocol on the page's side: reads what the server's own code wrote.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { decode, say } = await import(`${folder}protocol.js`);
const { OPERATIONS } = await import(`${folder}wire.js`);
const exchange = process.env.CAROM_EXCHANGE;
const read = (name) => {
  const bytes = readFileSync(`${exchange}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const expected = JSON.parse(readFileSync(`${exchange}/expected.json`, "utf8"));

test("a frame of the server", () => {
  const { kind, frame } = decode(read("frame.bin"));
  assert.equal(kind, "frame");
  for (const [name, value] of Object.entries(expected.frame)) {
    const got = frame[name];
    assert.deepEqual(ArrayBuffer.isView(got) ? [...got] : got, value, name);
  }
});

test("a scene of the server", () => {
  const { kind, scene } = decode(read("scene.bin"));
  assert.equal(kind, "scene");
  assert.deepEqual(scene.about, expected.scene.about);
  assert.deepEqual([...scene.radius], expected.scene.radius);
  assert.deepEqual([...scene.mass], [1, Infinity]);
  assert.deepEqual([...scene.color], expected.scene.color);
  assert.deepEqual([...scene.species], expected.scene.species);
});

test("what is cut short, foreign or of another version is refused", () => {
  const frame = read("frame.bin");
  assert.throws(() => decode(frame.slice(0, -1)), /a frame of 2 spheres/);
  assert.throws(() => decode(read("scene.bin").slice(0, -4)), /a scene of 2 spheres/);
  assert.throws(() => decode(new ArrayBuffer(8)), /no message/);
  assert.throws(() => decode(new ArrayBuffer(400)), /no message/);
  const other = frame.slice(0);
  new DataView(other).setUint16(4, 99, true);
  assert.throws(() => decode(other), /version 99/);
  const unknown = frame.slice(0);
  new DataView(unknown).setUint16(6, 7, true);
  assert.throws(() => decode(unknown), /kind 7/);
});

test("speeds beyond the limits are brought inside", () => {
  assert.equal(JSON.parse(say.speed(1e9)).value, 100);
  assert.equal(JSON.parse(say.speed(0)).value, 0.001);
});

test("everything it says is left for the server's own code to read", () => {
  const ball = { position: [1, 2, 3], velocity: [0, 0, 1], radius: 0.5, mass: 2, color: 0xff0000 };
  const said = [
    say.hello("token"), say.credit(2), say.play(), say.pause(), say.restart(), say.speed(0.5),
    say.step(), say.back(), say.reverse(), say.rule(0.9), say.walls(1), say.gravity([0, -1, 2]),
    say.scene("gas", { n: 50, speed: 1.5 }), say.add(ball), say.remove(3), say.push(7, [1, 2, 3]),
    say.compare(true), say.source(),
  ];
  assert.deepEqual(said.map((text) => JSON.parse(text).op).sort(), Object.keys(OPERATIONS).sort());
  writeFileSync(`${exchange}/said.json`, JSON.stringify(said));
});
