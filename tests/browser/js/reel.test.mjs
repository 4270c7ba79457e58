// Reels against Python's, in both directions; where films stand; which collisions they tell of.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { decodeReel, encodeReel } = await import(`${folder}reel.js`);
const { Film } = await import(`${folder}film.js`);
const { collisionsBetween } = await import(`${folder}collisions.js`);
const place = process.env.CAROM_EXCHANGE;

const reel = await decodeReel(readFileSync(`${place}/gas.reel`));

test("reads what Python writes, and writes what Python reads", async () => {
  for (const name of ["gas", "fluid", "bounce"]) {
    const { keyframes } = await decodeReel(readFileSync(`${place}/${name}.reel`));
    writeFileSync(`${place}/${name}.spheres`, Buffer.concat(keyframes.map(({ spheres }) => spheres)));
  }
  writeFileSync(`${place}/javascript.reel`, await encodeReel(reel));
});

test("refuses a file of another format", async () => {
  await assert.rejects(decodeReel(readFileSync(`${place}/later.reel`)), /format 99/);
});

/** A listener that keeps what it is told. */
const told = () => {
  const heard = { frames: [], events: [] };
  const listener = {
    scene: () => {},
    state: () => {},
    frame: ({ t, playing, reversed, epoch }) => heard.frames.push({ t, playing, reversed, epoch }),
    note: (key, value) => key === "event" && heard.events.push(value),
  };
  return { heard, listener };
};
const say = (film, op, more = {}) => film.send(JSON.stringify({ op, ...more }));

test("a film runs at the scene's pace, both ways, and stops at its ends", () => {
  const film = new Film(reel);
  const { heard, listener } = told();
  film.attach(listener);
  const { pace } = reel.scene.about;
  assert.equal(film.speed, 2); // as the file says
  say(film, "speed", { value: 1 });
  const [first, second] = film.advance(0.1);
  assert.ok(Math.abs(film.t - (film.start + 0.1 * pace)) < 1e-12);
  assert.ok(first.t <= film.t && film.t <= second.t);
  say(film, "speed", { value: 4 });
  film.advance(0.1);
  assert.ok(Math.abs(film.t - (film.start + 0.5 * pace)) < 1e-12);
  say(film, "reverse");
  film.advance(0.05);
  assert.ok(Math.abs(film.t - (film.start + 0.3 * pace)) < 1e-12);
  assert.equal(heard.frames.at(-1).reversed, true);
  film.advance(100);
  assert.equal(film.t, film.start);
  assert.equal(heard.frames.at(-1).playing, false);
  say(film, "reverse");
  say(film, "play");
  film.advance(1e9);
  assert.equal(film.t, film.end);
  assert.equal(film.playing, false);
  say(film, "play"); // again from the start
  film.advance(0);
  assert.equal(film.t, film.start);
});

test("frames can be gone through one by one", () => {
  const film = new Film(reel);
  film.attach(told().listener);
  film.advance(0.01);
  film.shift(1);
  assert.equal(film.t, reel.keyframes[1].t);
  film.shift(-1);
  assert.equal(film.t, reel.keyframes[0].t);
  film.shift(-1);
  assert.equal(film.t, reel.keyframes[0].t);
  film.seek(1e6);
  assert.equal(film.t, film.end);
  assert.equal(film.playing, false);
});

test("collisions are found where Python had them, in order, and can be stepped through", () => {
  const { collisions } = JSON.parse(readFileSync(`${place}/events.json`));
  const found = reel.keyframes
    .slice(1)
    .flatMap((second, k) => collisionsBetween(reel.keyframes[k], second, reel.scene));
  // Those of spheres that collide twice between two frames are not told.
  assert.ok(found.length > 0.9 * collisions.length, `${found.length} of ${collisions.length}`);
  let matched = 0;
  for (const { t, i, j, impulse } of found) {
    const true_ = collisions.find((each) => Math.min(each.i, each.j) === Math.min(i, j) && Math.max(each.i, each.j) === Math.max(i, j) && Math.abs(each.t - t) < 2e-3);
    if (true_ === undefined) continue;
    matched++;
    const sign = true_.i === i ? 1 : -1;
    for (let k = 0; k < 3; k++) assert.ok(Math.abs(impulse[k] - sign * true_.impulse[k]) < 2e-2);
  }
  assert.equal(matched, found.length);
  const film = new Film(reel);
  const { heard, listener } = told();
  film.attach(listener);
  const stops = [];
  for (let k = 0; k < 5; k++) {
    say(film, "step");
    film.advance(0.1);
    stops.push(film.t);
  }
  assert.deepEqual(stops, found.slice(0, 5).map(({ t }) => t));
  assert.equal(heard.events.length, 5);
  say(film, "back");
  assert.equal(film.t, stops[3]);
});
