// The governor of quality: what it chooses from measured times, and that it comes to rest.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { Governor, LEVELS, finest, isSoftware } = await import(`${folder}quality.js`);

const BEST = LEVELS.length - 1;

/** Pictures that take as long as a machine needs at each level, at a screen of 60 per second. */
function run(governor, costs, pictures) {
  const levels = [];
  for (let k = 0; k < pictures; k++) {
    levels.push(governor.level);
    governor.took(Math.max(16.7, costs[governor.level]) + (k % 3) * 0.3);
  }
  return levels;
}

const changes = (levels) => levels.filter((level, k) => k > 0 && level !== levels[k - 1]).length;

test("a fast machine has the best from the first picture and keeps it", () => {
  const governor = new Governor(false);
  governor.start(500);
  assert.deepEqual(new Set(run(governor, [2, 3, 5, 9], 2000)), new Set([BEST]));
});

test("a slow machine comes down to what it can do, in less than two seconds", () => {
  const governor = new Governor(false);
  governor.start(500);
  const levels = run(governor, [10, 30, 90, 200], 2000);
  assert.equal(levels.at(-1), 1);
  const time = levels.slice(0, levels.indexOf(1)).reduce((sum, l) => sum + [10, 30, 90, 200][l], 0);
  assert.ok(time < 2000, `${time} ms`);
});

test("between slow and quick it stays where it is", () => {
  const governor = new Governor(false);
  governor.start(500);
  assert.equal(changes(run(governor, [8, 16, 25, 33.4], 3000)), 0); // a screen of 30 per second
});

test("it does not swing: each new trial waits twice as long", () => {
  const governor = new Governor(false);
  governor.start(500);
  const levels = run(governor, [5, 10, 60, 120], 60 * 60 * 5); // five minutes
  assert.ok(changes(levels.slice(0, 3600)) <= 12, `${changes(levels.slice(0, 3600))} in a minute`);
  assert.ok(changes(levels.slice(-3600)) <= 6, `${changes(levels.slice(-3600))} in the last minute`);
  const atRest = levels.slice(-3600).filter((level) => level === 1).length;
  assert.ok(atRest > 3300, `${atRest} of 3600 pictures at the level that is right`);
});

test("it rises again when the load is gone", () => {
  const governor = new Governor(false);
  governor.start(500);
  run(governor, [50, 80, 90, 100], 500);
  assert.equal(governor.level, 0);
  run(governor, [4, 5, 6, 7], 4000);
  assert.equal(governor.level, BEST);
});

test("one late picture says nothing, and neither does a hidden page", () => {
  const governor = new Governor(false);
  governor.start(500);
  for (let k = 0; k < 600; k++) governor.took(k % 20 === 0 ? 400 : 16.7);
  assert.equal(governor.level, BEST);
  for (let k = 0; k < 60; k++) governor.took(60_000);
  assert.equal(governor.level, BEST);
});

test("software painters are known by name and start low", () => {
  for (const name of [
    "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)), SwiftShader driver)",
    "llvmpipe (LLVM 17.0.6, 256 bits)",
    "Microsoft Basic Render Driver",
  ]) assert.ok(isSoftware(name), name);
  for (const name of ["ANGLE (Intel, Mesa Intel(R) UHD Graphics 620)", "Apple M1", ""]) {
    assert.ok(!isSoftware(name), name);
  }
  const governor = new Governor(true);
  governor.start(1000);
  assert.equal(governor.level, 0);
  run(governor, [1, 1, 1, 1], 3000);
  assert.equal(governor.level, 0);
  governor.start(5);
  assert.equal(governor.level, 1);
});

test("great swarms begin without shadows, and the cheapest level takes fewer pixels", () => {
  const governor = new Governor(false);
  governor.start(100_000);
  assert.equal(governor.level, 1);
  assert.ok(finest(0, 100_000) < finest(0, 1000));
  assert.equal(finest(3, 100_000), LEVELS[3].finest);
});

test("a forced level stays until it is let go; others are refused", () => {
  const governor = new Governor(false);
  governor.start(10);
  governor.force(2);
  run(governor, [500, 500, 500, 500], 100);
  assert.equal(governor.level, 2);
  governor.force(null);
  assert.equal(governor.level, BEST);
  assert.throws(() => governor.force(7), /0 to 3/);
  assert.throws(() => governor.force(1.5), /0 to 3/);
});
