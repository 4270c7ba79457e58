// Keys, sliders, links, legends, gravity and the layout: the parts of the page that need no page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const load = (name) => import(`${folder}${name}.js`);
const { KEYS, ownKey, printed, rowOf, titleOf } = await load("keys");
const { placeOf, places, roundUp, valueAt } = await load("scales");
const { formatLink, readLink, runsAlready } = await load("link");
const { fullOf } = await load("legend");
const { DIRECTIONS, allowed, angles, direction } = await load("gravity");
const { around, halves } = await load("split");
const { layout } = await load("layout");
const { settled, spaced } = await load("later");
const { labelOf } = await load("parameters");

test("no key has two meanings, and each can be found, printed and quoted", () => {
  const all = KEYS.flatMap(({ keys, also = [] }) => [...keys, ...also]);
  assert.equal(new Set(all).size, all.length);
  for (const row of KEYS) for (const key of row.keys) assert.equal(rowOf(key), row);
  assert.equal(rowOf("N").action, "step");
  assert.equal(rowOf("z"), undefined);
  assert.equal(printed(" "), "space");
  assert.equal(printed("r"), "R");
  assert.equal(titleOf("restart"), "Restart (R)");
  assert.equal(titleOf("toggle", "Pause"), "Pause (space)");
});

test("an element with the focus keeps the keys that it uses itself", () => {
  const range = { tag: "input", type: "range", role: "" };
  const number = { tag: "input", type: "number", role: "" };
  const button = { tag: "button", type: "button", role: "" };
  const radio = { tag: "input", type: "radio", role: "" };
  assert.ok(ownKey(range, "arrowleft") && ownKey(range, "home") && !ownKey(range, " "));
  assert.ok(!ownKey(range, "n"));
  assert.ok(ownKey(number, "1") && ownKey(number, "r") && ownKey(number, "backspace"));
  assert.ok(ownKey(button, " ") && ownKey(button, "enter") && !ownKey(button, "n"));
  assert.ok(ownKey(radio, "arrowup") && !ownKey(radio, "w"));
  assert.ok(!ownKey({ tag: "canvas", type: "", role: "img" }, "arrowleft"));
});

test("sliders reach both ends and come back to the place they were at", () => {
  const ranges = [
    { low: 0, high: 1 },
    { low: 2, high: 12, whole: true },
    { low: 1, high: 100_000, log: true, whole: true },
    { low: 0.001, high: 0.5, log: true },
    { low: -5, high: 37.5 },
  ];
  for (const range of ranges) {
    const last = places(range);
    assert.equal(valueAt(range, 0), range.low);
    assert.equal(valueAt(range, last), range.high);
    let before = -Infinity;
    for (let place = 0; place <= last; place++) {
      const value = valueAt(range, place);
      assert.ok(value >= before && value >= range.low && value <= range.high);
      if (range.whole) assert.ok(Number.isInteger(value));
      before = value;
      if (!range.whole) assert.ok(Math.abs(placeOf(range, value) - place) <= 1);
    }
    assert.equal(placeOf(range, range.low - 1), 0);
    assert.equal(placeOf(range, range.high + 1), last);
  }
  assert.equal(places({ low: 2, high: 12, whole: true }), 10);
  assert.equal(valueAt({ low: 2, high: 12, whole: true }, 3), 5);
  assert.ok(String(valueAt({ low: 0, high: 1 }, 137)).length <= 6);
});

test("scales end at 1, 2, 5, 10 …", () => {
  const ends = [0, 1, 1.5, 3, 5, 6, 11, 99, 101, 500, 501].map(roundUp);
  assert.deepEqual(ends, [1, 1, 2, 5, 5, 10, 20, 100, 200, 500, 1000]);
});

test("the scale of collisions grows with the largest count and ignores the bit of rest", () => {
  const scene = { about: { full_speed: 3, full_energy: 7 } };
  assert.equal(fullOf("speed", scene, undefined), 3);
  assert.equal(fullOf("energy", scene, undefined), 7);
  assert.equal(fullOf("collisions", scene, undefined), 5);
  assert.equal(fullOf("collisions", scene, { counts: Uint32Array.of(1, 12) }), 20);
  assert.equal(fullOf("collisions", scene, { counts: Uint32Array.of(0x80000000 + 3, 0) }), 5);
});

test("the scales of energy and speed are those of the frame, before there is one of the scene", () => {
  const scene = { about: { full_speed: 3, full_energy: 7 } };
  assert.equal(fullOf("speed", scene, { fullSpeed: 20, fullEnergy: 50 }), 20);
  assert.equal(fullOf("energy", scene, { fullSpeed: 20, fullEnergy: 50 }), 50);
});

test("links come back as they were sent", () => {
  const origin = { name: "gas", options: { n: 200, packing_fraction: 0.05, seed: 3, cold: true } };
  const link = formatLink("http://127.0.0.1:8000/", "se-cret_1", origin);
  const hash = link.slice(link.indexOf("#"));
  assert.deepEqual(readLink(hash), origin);
  assert.equal(new URLSearchParams(hash.slice(1)).get("token"), "se-cret_1");
  assert.equal(readLink("#token=abc"), null);
  assert.equal(readLink(""), null);
  assert.deepEqual(readLink("#scene=a&word=x%20y&none="), { name: "a", options: { word: "x y", none: "" } });
  assert.equal(formatLink("http://h/", "t", null), "http://h/#token=t");
});

test("a link to what runs already changes nothing", () => {
  const running = { name: "gas", options: { n: 200, seed: 3 } };
  assert.ok(runsAlready({ name: "gas", options: { n: 200 } }, running));
  assert.ok(!runsAlready({ name: "gas", options: { n: 201 } }, running));
  assert.ok(!runsAlready({ name: "fluid", options: {} }, running));
  assert.ok(!runsAlready({ name: "gas", options: {} }, null));
});

const near = (a, b) => a.every((part, k) => Math.abs(part - b[k]) < 1e-12);

test("gravity's two angles and its vector agree", () => {
  const frame = { up: [0, 1, 0], forward: [0, 0, -1], right: [1, 0, 0] };
  assert.deepEqual(direction(frame, 0, 0), [0, -1, 0]);
  assert.deepEqual(direction(frame, 180, 77).map((x) => x + 0), [0, 1, 0]);
  assert.ok(near(direction(frame, 90, 0), [1, 0, 0]));
  assert.ok(near(direction(frame, 90, 90), [0, 0, -1]));
  for (const [tilt, heading] of [[30, 0], [90, 120], [140, 300], [45.5, 10]]) {
    const unit = direction(frame, tilt, heading);
    assert.ok(Math.abs(Math.hypot(...unit) - 1) < 1e-12);
    const back = angles(frame, unit.map((part) => 9.81 * part));
    assert.ok(Math.abs(back.strength - 9.81) < 1e-12);
    assert.deepEqual([back.tilt, back.heading], [tilt, heading]);
  }
  assert.deepEqual(angles(frame, [0, 0, 0]), { strength: 0, tilt: 0, heading: 0 });
});

test("gravity never points along a periodic axis", () => {
  const frame = { up: [0, 0, 1], forward: [0, 1, 0], right: [1, 0, 0] };
  const open = (period) =>
    DIRECTIONS.filter(([, , tilt, heading]) => allowed(direction(frame, tilt, heading), period));
  assert.equal(open([0, 0, 0]).length, 6);
  assert.deepEqual(open([5, 5, 0]).map(([name]) => name), ["down", "up"]);
  assert.equal(open([5, 5, 5]).length, 0);
});

test("the halves of the split screen are equal and fill what is free", () => {
  assert.deepEqual(halves(1001, 0, 700, false), [
    { x: 0, y: 0, width: 500, height: 700 },
    { x: 500, y: 0, width: 500, height: 700 },
  ]);
  assert.deepEqual(halves(390, 60, 700, true), [
    { x: 0, y: 60, width: 390, height: 320 },
    { x: 0, y: 380, width: 390, height: 320 },
  ]);
});

test("the layout leaves the panel and the bar free", () => {
  const page = { width: 1280, height: 720, right: 970, bottom: 650, top: 60, labels: 0, narrow: false };
  const one = layout(page);
  assert.deepEqual(one.viewports, [{ x: 0, y: 0, width: 1280, height: 720 }]);
  assert.deepEqual(one.insets, { left: 0, right: 310, top: 0, bottom: 70 });
  const two = layout({ ...page, labels: 80 });
  assert.deepEqual(two.size, { width: 485, height: 720 });
  assert.equal(two.insets.right, 0);
  assert.ok(two.insets.top === 140 && two.insets.bottom >= 70);
  const phone = layout({ ...page, width: 390, height: 844, right: 390, bottom: 740, labels: 80, narrow: true });
  assert.ok(phone.viewports.every(({ y, height }) => y >= 60 && y + height <= 740));
  assert.deepEqual(phone.size, { width: 390, height: phone.viewports[0].height });
  // Above an open sheet a tablet is wider than high.
  const tablet = layout({ ...page, width: 820, height: 1180, right: 820, bottom: 510, labels: 80, narrow: true });
  assert.deepEqual(tablet.viewports.map(({ x, y }) => [x, y]), [[0, 60], [410, 60]]);
});

test("the ticks are shown at the moment of the exact side", () => {
  const frames = [1, 2, 3].map((t) => ({ t }));
  assert.equal(around([], 1), null);
  assert.deepEqual(around(frames, 2.5).map(({ t }) => t), [2, 3]);
  assert.deepEqual(around(frames, 2).map(({ t }) => t), [2, 3]);
  assert.deepEqual(around(frames, 0).map(({ t }) => t), [1, 1]);
  assert.deepEqual(around(frames, 9).map(({ t }) => t), [2, 3]);
});

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

test("a moving slider sends the newest value, not all", async () => {
  const once = [];
  const calm = settled((value) => once.push(value), 30);
  for (let k = 0; k < 5; k++) calm(k);
  assert.deepEqual(once, []);
  await sleep(60);
  assert.deepEqual(once, [4]);
  const some = [];
  const paced = spaced((value) => some.push(value), 30);
  for (let k = 0; k < 5; k++) paced(k);
  assert.deepEqual(some, [0]);
  await sleep(80);
  assert.deepEqual(some, [0, 4]);
  paced(5);
  assert.deepEqual(some, [0, 4, 5]);
});

test("options are named as people name them", () => {
  assert.equal(labelOf("n"), "Number of spheres");
  assert.equal(labelOf("packing_fraction"), "Packing fraction");
});
