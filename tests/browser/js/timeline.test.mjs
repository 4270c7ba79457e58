// The clock of the page: always between two known keyframes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { Timeline } = await import(`${folder}timeline.js`);

const frame = (t, clock, more = {}) => ({ t, clock, epoch: 0, scene: 1, playing: true, ...more });

test("runs smoothly about one keyframe behind, and never beyond the newest", () => {
  const line = new Timeline();
  let last = -Infinity;
  const steps = [];
  for (let k = 0; k < 120; k++) {
    line.push(frame(2 * (k / 60), 100 + k / 60));
    const [a, b] = line.advance(1 / 60);
    assert.ok(a.t <= line.t && line.t <= b.t);
    assert.ok(line.t >= last);
    if (k > 60) steps.push(line.t - last);
    last = line.t;
  }
  for (const step of steps) assert.ok(Math.abs(step - 2 / 60) < 1e-3, `${step}`);
  const behind = (line.newest.t - line.t) / (2 / 60);
  assert.ok(behind > 0 && behind < 2, `${behind}`);
});

test("never goes back, however late keyframes come and however seldom pictures are drawn", () => {
  const line = new Timeline();
  let late = 1;
  let last = -Infinity;
  for (let k = 0; k < 200; k++) {
    late = (late * 48271) % 2147483647; // numbers that are the same in every run
    // The speed changes too, by factors of a thousand.
    if (late % 3) line.push(frame((line.newest?.t ?? 0) + (k % 70 < 35 ? 1 : 1000), k / 10));
    if (line.advance((late % 5) / 16) === null) continue;
    assert.ok(line.t >= last && line.t <= line.newest.t, `${line.t} after ${last}`);
    last = line.t;
  }
});

test("a pause ends exactly at the last keyframe", () => {
  const line = new Timeline();
  for (let k = 0; k < 30; k++) {
    line.push(frame(k / 60, k / 60));
    line.advance(1 / 60);
  }
  line.push(frame(0.5, 0.5, { playing: false }));
  for (let k = 0; k < 60; k++) line.advance(1 / 60);
  assert.equal(line.t, 0.5);
  const [, b] = line.advance(1 / 60);
  assert.equal(b.t, 0.5);
});

test("late keyframes: it waits at the newest and does not guess", () => {
  const line = new Timeline();
  line.push(frame(0, 0));
  line.push(frame(0.1, 0.1));
  for (let k = 0; k < 60; k++) line.advance(1 / 60);
  assert.equal(line.t, 0.1);
});

test("a restart, another scene or a long silence is a jump, not a slide", () => {
  for (const next of [
    frame(0, 5.02, { epoch: 1 }),
    frame(5.02, 5.02, { scene: 2 }),
    frame(9, 9),
    frame(4, 5.02),
  ]) {
    const line = new Timeline();
    line.push(frame(4.98, 4.98));
    line.push(frame(5, 5));
    line.push(next);
    assert.deepEqual(line.advance(0), [next, next]);
    assert.equal(line.t, next.t);
  }
});

test("nothing to show before the first keyframe", () => {
  assert.equal(new Timeline().advance(1), null);
});
