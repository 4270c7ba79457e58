// Picking, trails, the flash of a collision, new balls, and the camera as hands use it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { Camera } = await import(`${folder}camera.js`);
const { placeOf, wrap } = await import(`${folder}interpolation.js`);
const { everywhere, pick } = await import(`${folder}pick.js`);
const { Trail } = await import(`${folder}trail.js`);
const { Flash, contact } = await import(`${folder}flash.js`);
const { arrowEnds, arrowTime, velocityTo } = await import(`${folder}arrows.js`);
const { NewBall, median } = await import(`${folder}newball.js`);
const { buildWalls, reachOf } = await import(`${folder}walls.js`);
const { aligned } = await import(`${folder}inspector.js`);

/** Numbers that are the same in every run (mulberry32). */
function dice(seed) {
  return (low = 0, high = 1) => {
    seed = (seed + 0x6d2b79f5) | 0;
    let z = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    z = (z + Math.imul(z ^ (z >>> 7), 61 | z)) ^ z;
    return low + ((high - low) * ((z ^ (z >>> 14)) >>> 0)) / 2 ** 32;
  };
}
const three = (roll, size) => [roll(-size, size), roll(-size, size), roll(-size, size)];
const near = (a, b, error) =>
  a.forEach((value, k) => assert.ok(Math.abs(value - b[k]) <= error, `${a} is not ${b}`));
const along = ({ origin, direction }, s) => origin.map((part, k) => part + s * direction[k]);
const length = (a) => Math.hypot(...a);
const minus = (a, b) => a.map((part, k) => part - b[k]);

/** Any camera, in a window with panels, perhaps on its way. */
function anyCamera(roll) {
  const camera = new Camera();
  camera.resize(roll(200, 1500), roll(200, 900), {
    left: roll(0, 80), right: roll(0, 80), top: roll(0, 80), bottom: roll(0, 80),
  });
  camera.reach = 8;
  camera.look(three(roll, 20), three(roll, 3));
  if (roll() < 0.5) camera.glide(() => camera.turn(roll(-1, 1), roll(-0.5, 0.5)));
  return camera;
}

test("a line of sight meets places where they are seen", () => {
  const roll = dice(1);
  for (let k = 0; k < 300; k++) {
    const camera = anyCamera(roll);
    const [x, y, s] = [roll(0, camera.size.width), roll(0, camera.size.height), roll(0.5, 40)];
    const point = along(camera.ray(x, y), s);
    const seen = camera.project(point);
    near([seen.x, seen.y], [x, y], 1e-7);
    assert.ok(camera.project(along(camera.ray(x, y), -s)).depth < 0);
    // The matrices that the pictures are drawn with agree.
    const apply = (m, v) => [0, 1, 2, 3].map((r) => v.reduce((sum, p, c) => sum + m[4 * c + r] * p, 0));
    const [a, b, , w] = apply(camera.projection, apply(camera.view, [...point, 1]));
    const drawn = [((a / w + 1) / 2) * camera.size.width, ((1 - b / w) / 2) * camera.size.height];
    near([seen.x, seen.y], drawn, 2e-2);
    assert.ok(Math.abs(w - seen.depth) < 1e-4);
    // A ball of radius r there is r · scale pixels high.
    const { up } = camera.axes;
    const top = camera.project(point.map((part, j) => part + up[j]));
    assert.ok(Math.abs(seen.y - top.y - seen.scale) < 1e-6 * seen.scale);
    const place = three(roll, 4);
    if (camera.project(place).depth < 1) continue;
    const spot = camera.onPlane(x, y, place);
    near([camera.project(spot).depth], [camera.project(place).depth], 1e-9);
    near([camera.project(spot).x, camera.project(spot).y], [x, y], 1e-6);
  }
});

test("it glides from where it was to where it goes, and arrives", () => {
  const camera = new Camera();
  camera.resize(800, 600, { left: 0, right: 0, top: 0, bottom: 0 });
  camera.look([3, -7, 4], [1, 2, 3]);
  const before = camera.eye;
  camera.glide(() => camera.look([-9, 1, 1], [0, 0, 0]));
  near(camera.eye, before, 1e-9);
  assert.ok(camera.gliding);
  let away = Infinity;
  for (let k = 0; k < 120; k++) {
    const { version } = camera;
    camera.advance(1 / 60);
    const left = length(minus(camera.eye, [-9, 1, 1]));
    if (k > 5 && camera.gliding) assert.ok(left < away && camera.version > version);
    away = left;
  }
  assert.ok(!camera.gliding);
  near(camera.eye, [-9, 1, 1], 1e-9);
  const { version } = camera;
  camera.advance(1);
  assert.equal(camera.version, version);
  camera.calm = true;
  camera.glide(() => camera.look([1, 1, 5], [0, 0, 0]));
  near(camera.eye, [1, 1, 5], 1e-9);
});

test("it turns the short way round", () => {
  const camera = new Camera();
  camera.azimuth = 3;
  camera.glide(() => (camera.azimuth = -3));
  assert.ok(Math.abs(camera.lag.azimuth) < 0.3);
});

test("it follows exactly, jumps along, and is let go by moving or showing everything", () => {
  const camera = new Camera();
  camera.resize(800, 600, { left: 0, right: 0, top: 0, bottom: 0 });
  camera.look([0, -10, 2], [0, 0, 0]);
  const eye = camera.eye;
  camera.follow([1, 2, 3]);
  near(camera.eye, eye, 1e-9);
  for (let k = 0; k < 120; k++) camera.advance(1 / 60);
  for (const place of [[1.1, 2, 3], [-5, 2, 3]]) {
    camera.carry(place);
    near(camera.center, place, 0);
    const { x, y } = camera.project(place);
    near([x, y], [400, 300], 1e-9);
  }
  camera.turn(0.3, 0.1);
  camera.zoom(0.5);
  assert.ok(camera.follows);
  camera.pan(5, 5);
  assert.ok(!camera.follows);
  const { target } = camera;
  camera.carry([9, 9, 9]);
  near(camera.target, target, 0);
  camera.follow([1, 2, 3]);
  camera.fit({ center: [0, 0, 0], points: [[1, 1, 1]], margin: 1 });
  assert.ok(!camera.follows);
});

/** Two keyframes of n spheres; some fly, some have hit something, some rest. */
function anyPair(roll, n, size, period, h) {
  const gravity = [0, 0, roll() < 0.5 ? 0 : -3];
  const make = (t) => ({
    n, t, epoch: 0, gravity,
    position: new Float32Array(3 * n), velocity: new Float32Array(3 * n), counts: new Uint32Array(n),
  });
  const [first, second] = [make(2), make(2 + h)];
  for (let i = 0; i < n; i++) {
    const [x, v, w] = [three(roll, size), three(roll, 6), three(roll, 6)];
    const hits = Math.floor(roll(0, 3.5));
    const at = roll(0, h);
    const fly = (a, b, s) => a.map((part, k) => part + b[k] * s + 0.5 * gravity[k] * s * s);
    const faster = (b, s) => b.map((part, k) => part + gravity[k] * s);
    const [end, speed] = hits === 0 ? [fly(x, v, h), faster(v, h)] : [fly(fly(x, v, at), w, h - at), faster(w, h - at)];
    first.position.set(wrap(x, period), 3 * i);
    first.velocity.set(v, 3 * i);
    second.position.set(wrap(end, period), 3 * i);
    second.velocity.set(speed, 3 * i);
    first.counts[i] = 5;
    second.counts[i] = 5 + hits;
  }
  return [first, second];
}

/** The obvious way: every sphere where it is drawn, and where the line enters it. */
function pickSlowly(first, second, t, radius, period, { origin, direction }) {
  let [best, nearest] = [null, Infinity];
  for (let i = 0; i < first.n; i++) {
    const { x } = placeOf(first, second, t, i, period);
    const shifts = (k) => (period[k] > 0 ? [-period[k], 0, period[k]] : [0]);
    for (const sx of shifts(0)) for (const sy of shifts(1)) for (const sz of shifts(2)) {
      const image = [x[0] + sx, x[1] + sy, x[2] + sz];
      // Seen if any of it is in the box.
      if (image.some((part, k) => period[k] > 0 && Math.abs(part) - radius[i] > 0.5 * period[k])) continue;
      const c = minus(image, origin);
      const b = c.reduce((sum, part, k) => sum + part * direction[k], 0);
      const root = b * b - (c.reduce((sum, part) => sum + part * part, 0) - radius[i] ** 2);
      if (root < 0 || b <= 0) continue;
      if (b - Math.sqrt(root) < nearest) [best, nearest] = [i, b - Math.sqrt(root)];
    }
  }
  return best;
}

test("a sphere at a corner of a periodic box is seen eight times", () => {
  assert.deepEqual(everywhere([1, 2, 3], 1, [10, 10, 10]), [[1, 2, 3]]);
  assert.deepEqual(everywhere([-4.5, 2, 3], 1, [10, 10, 0]), [[-4.5, 2, 3], [5.5, 2, 3]]);
  const eight = everywhere([-4.5, 4.5, 4.9], 1, [10, 10, 10]);
  assert.equal(new Set(eight.map(String)).size, 8);
  assert.ok(eight.every((x) => x.every((part) => Math.abs(part) < 6)));
});

test("the nearest sphere of all, at any moment, in open and periodic worlds", () => {
  const roll = dice(2);
  let hits = 0;
  for (let k = 0; k < 400; k++) {
    const period = k % 2 ? [0, 0, 0] : [10, 10, roll() < 0.5 ? 10 : 0];
    const [first, second] = anyPair(roll, 60, 5, period, roll(0.01, 0.6));
    const radius = Float32Array.from({ length: 60 }, () => roll(0.05, 0.8));
    const t = k % 5 === 0 ? second.t : roll(first.t, second.t);
    const camera = anyCamera(roll);
    const { x, y } = camera.project(three(roll, 5));
    const ray = camera.ray(x, y);
    const expected = pickSlowly(first, second, t, radius, period, ray);
    assert.equal(pick(first, second, t, radius, period, ray, 0), expected);
    if (expected !== null) {
      hits++;
      assert.equal(pick(first, second, t, radius, period, ray, 0.02), expected);
    }
  }
  assert.ok(hits > 100, `${hits}`);
});

test("a sphere that is just missed, and nothing where nothing is", () => {
  const frame = {
    n: 2, t: 0, epoch: 0, gravity: [0, 0, 0],
    position: Float32Array.of(0, 0, 10, 0.5, 0, 20), velocity: new Float32Array(6), counts: new Uint32Array(2),
  };
  const radius = Float32Array.of(0.1, 0.1);
  const ray = (x) => ({ origin: [x, 0, 0], direction: [0, 0, 1] });
  const at = (x, slack) => pick(frame, frame, 0, radius, [0, 0, 0], ray(x), slack);
  assert.equal(at(0.15, 0), null);
  assert.equal(at(0.15, 0.006), 0); // 0.05 beside it, ten away
  assert.equal(at(0.15, 0.004), null);
  assert.equal(at(0.38, 0.05), 1); // beside both: 0.028 and 0.001 per unit of distance
  assert.equal(pick(frame, frame, 0, radius, [0, 0, 0], { origin: [0, 0, 30], direction: [0, 0, 1] }, 0.1), null);
});

test("a hundred thousand spheres are asked within a frame", () => {
  const roll = dice(3);
  const n = 100_000;
  const [first, second] = anyPair(roll, n, 50, [100, 100, 100], 1 / 60);
  const radius = new Float32Array(n).fill(0.4);
  const ray = { origin: [0, -200, 3], direction: [0, 1, 0] };
  let best = Infinity;
  for (let k = 0; k < 12; k++) {
    const start = performance.now();
    pick(first, second, 2 + 1 / 120, radius, [100, 100, 100], ray, 0.001);
    best = Math.min(best, performance.now() - start);
  }
  console.log(`picking one of ${n}: ${best.toFixed(2)} ms`);
  assert.ok(best < 16, `${best} ms`);
});

const OPEN = [0, 0, 0];
const frame = (t, x, v, hits, more = {}) => ({
  n: 1, t, clock: 0, epoch: 0, gravity: OPEN,
  position: Float32Array.from(x), velocity: Float32Array.from(v), counts: Uint32Array.of(hits), ...more,
});
const listed = (trail) => {
  const flat = [...trail.points];
  return flat.flatMap((_, k) => (k % 3 === 0 ? [flat.slice(k, k + 3)] : []));
};

test("a trail has the exact corner of a collision between two pictures, once", () => {
  // To the right, at t = 0.25 upwards; three keyframes, four pictures.
  const frames = [frame(0, [0, 0, 0], [4, 0, 0], 0), frame(1, [1, 0, 3], [0, 0, 4], 1), frame(2, [1, 0, 7], [0, 0, 4], 1)];
  for (const moments of [[0, 0.2, 0.5, 1, 1.5], [0.2, 0.5, 1, 2], [0.125, 1.5]]) {
    const trail = new Trail();
    for (const t of moments) {
      const k = t <= 1 ? 0 : 1;
      trail.extend(frames[k], frames[k + 1], t, 0, OPEN);
    }
    const points = listed(trail);
    assert.equal(points.length, moments.length + 1);
    const corners = points.filter(([x, , z]) => x === 1 && z === 0);
    assert.equal(corners.length, 1);
    near(points.at(-1), [1, 0, 4 * (moments.at(-1) - 0.25)], 1e-6);
  }
});

test("while time stands a trail does not grow", () => {
  const trail = new Trail();
  const pair = [frame(0, [0, 0, 0], [1, 0, 0], 0), frame(1, [1, 0, 0], [1, 0, 0], 0)];
  for (let k = 0; k < 5; k++) trail.extend(...pair, 0.5, 0, OPEN);
  assert.equal(listed(trail).length, 1);
});

test("a trail is interrupted at periodic borders and by jumps of the motion", () => {
  const trail = new Trail();
  const period = [10, 0, 0];
  const [a, b] = [frame(0, [4.5, 0, 0], [2, 0, 0], 0), frame(1, [-3.5, 0, 0], [2, 0, 0], 0)];
  for (const t of [0, 0.2, 0.4, 0.6]) trail.extend(a, b, t, 0, period);
  let points = listed(trail);
  assert.deepEqual(points.map(([x]) => Number.isNaN(x)), [false, false, true, false, false]);
  near([points[1][0], points[3][0]], [4.9, -4.7], 1e-6);
  const again = frame(0.6, [1, 1, 1], [0, 0, 0], 0, { epoch: 1 });
  const woken = frame(90, [2, 1, 1], [0, 0, 0], 0, { epoch: 1, clock: 60 });
  for (const late of [again, woken]) {
    trail.extend(late, late, late.t, 0, period);
    points = listed(trail);
    assert.ok(Number.isNaN(points.at(-2)[0]));
    near(points.at(-1), [late.position[0], 1, 1], 0);
  }
});

test("a trail keeps its newest points only", () => {
  const trail = new Trail(10);
  const pair = [frame(0, [0, 0, 0], [1, 0, 0], 0), frame(100, [100, 0, 0], [1, 0, 0], 0)];
  for (let t = 0; t <= 57; t++) {
    trail.extend(...pair, t, 0, OPEN);
    const xs = listed(trail).map(([x]) => x);
    assert.deepEqual(xs, Array.from({ length: Math.min(10, t + 1) }, (_, k) => t - Math.min(9, t) + k));
  }
});

const scene = (more = {}) => ({
  n: 2,
  radius: Float32Array.of(1, 2),
  mass: Float32Array.of(1, 3),
  about: { period: OPEN, low: [-1, -1, -1], high: [5, 1, 1], full_speed: 2, walls: [
    { kind: 0, normal: [1, 0, 0], offset: -1 }, { kind: 1, normal: OPEN, offset: 5 }, { kind: 2, normal: OPEN, offset: 5 },
  ] },
  ...more,
});

test("the contact is on the ball, towards what it touched", () => {
  near(contact({ i: 0, j: 1 }, scene(), [0, 0, 0], [3, 0, 0]), [1, 0, 0], 1e-12);
  near(contact({ i: 1, j: 0 }, scene(), [3, 0, 0], [0, 0, 0]), [1, 0, 0], 1e-12);
  near(contact({ i: 0, j: -1 }, scene(), [0, 4, 0], null), [-1, 4, 0], 1e-12);
  near(contact({ i: 0, j: -2 }, scene(), [0, 4, 0], null), [0, 5, 0], 1e-12);
  near(contact({ i: 0, j: -3 }, scene(), [0, 4, 3], null), [0, 5, 3], 1e-12);
  const periodic = scene();
  periodic.about = { ...periodic.about, period: [10, 0, 0] };
  near(contact({ i: 0, j: 1 }, periodic, [-4, 0, 0], [3, 0, 0]), [-5, 0, 0], 1e-12);
});

test("a flash stays while time stands, fades when it goes on, and ends with the motion", () => {
  const still = (t, more) => ({ ...frame(t, [0, 0, 0, 3, 0, 0], new Array(6).fill(0), 0), n: 2, counts: new Uint32Array(2), playing: false, ...more });
  const side = (t, more) => ({ first: still(t, more), second: still(t, more), t });
  const event = { t: 1, i: 0, j: 1, impulse: [-2, 0, 0] };
  const parts = (flash, s) => flash.parts(s, scene(), [1, 0, 0]);
  const flash = new Flash();
  flash.show(event, 0);
  flash.update(side(0.9), scene(), 10); // the moment has not come
  assert.equal(parts(flash, side(0.9)).marks.length, 0);
  flash.update(side(1), scene(), 20);
  const { marks, arrows } = parts(flash, side(1));
  // Each ball has its ring, and one that starts to run outwards.
  const rings = marks.map((mark) => [mark.radius, ...mark.x]);
  assert.deepEqual(rings, [[1, 0, 0, 0], [1, 0, 0, 0], [2, 3, 0, 0], [2, 3, 0, 0]]);
  assert.equal(marks[0].strength, 1);
  near(arrows[0].from, [1, 0, 0], 1e-12);
  near(arrows[0].to, [-2.4, 0, 0], 1e-12);
  assert.equal(arrows[0].strength, 1);
  flash.update(side(1), scene(), 60_000);
  const settled = flash.strength;
  assert.ok(settled > 0.2 && settled < 0.6);
  assert.equal(flash.update(side(1), scene(), 60_100), false); // nothing to draw again
  flash.update(side(1.1, { playing: true }), scene(), 61_000);
  flash.update(side(1.2, { playing: true }), scene(), 61_750);
  assert.ok(Math.abs(flash.strength - settled / 2) < 0.02);
  assert.equal(parts(flash, side(1.2)).arrows[0].strength, 0.5);
  assert.equal(flash.update(side(1.3, { playing: true }), scene(), 62_501), true);
  assert.equal(parts(flash, side(1.3)).marks.length, 0);
  for (const end of [{ epoch: 7 }]) {
    flash.show(event, 0);
    flash.update(side(1), scene(), 20);
    flash.update(side(1, end), scene(), 40);
    assert.equal(parts(flash, side(1)).arrows.length, 0);
  }
  flash.show({ ...event, t: 50 }, 0); // never comes
  flash.update(side(1), scene(), 4000);
  assert.equal(flash.event, null);
  flash.calm = true;
  flash.show(event, 0);
  const strengths = [20, 500, 9000].map((now) => (flash.update(side(1), scene(), now), flash.strength));
  assert.ok(new Set(strengths).size === 1 && strengths[0] > 0);
});

test("a new ball is like the others and flies where its arrow ends", () => {
  const ball = new NewBall();
  ball.resemble(scene({ mass: Float32Array.of(Infinity, 3) }), 10);
  assert.deepEqual([ball.radius, ball.mass], [2, 3]);
  ball.resemble(scene({ n: 0, mass: new Float32Array(0), radius: new Float32Array(0) }), 10);
  assert.deepEqual([ball.radius, ball.mass], [0.4, 1]);
  assert.equal(ball.release(), null);
  ball.put([1, 2, 3]);
  ball.aim([1, 2, 3.2], 0.5);
  assert.deepEqual(ball.ghost.velocity, [0, 0, 0]); // still inside the ball
  ball.aim([1, 2, 7], 0.5);
  const first = ball.release();
  near(first.velocity, [0, 0, 2 * (4 - 0.96 * 0.4)], 1e-12);
  assert.deepEqual(first.position, [1, 2, 3]);
  ball.put([0, 0, 0]);
  const second = ball.release();
  assert.ok(second.color !== first.color && Number.isInteger(second.color) && second.color < 2 ** 24);
  assert.equal(median([5, 1, 3]), 3);
  assert.ok(Math.abs(reachOf(buildWalls(scene().about).bounds) - 5) < 1e-12);
});

test("arrows of velocities grow out of the surface, and say which velocity they mean", () => {
  // As long as some radii, or a part of the scene where spheres are small; never endless.
  assert.equal(arrowTime(1, 10, { full_speed: 2 }), 2.5);
  assert.equal(arrowTime(0.01, 10, { full_speed: 2 }), 1);
  assert.ok(arrowTime(0, 10, { full_speed: 0 }) > 0);
  const roll = dice(4);
  for (let k = 0; k < 50; k++) {
    const [x, v, radius, time] = [three(roll, 9), three(roll, 3), roll(0.1, 2), roll(0.1, 5)];
    const { from, to } = arrowEnds(x, radius, v, time);
    assert.ok(Math.abs(length(minus(from, x)) - 0.96 * radius) < 1e-9);
    assert.ok(Math.abs(length(minus(to, from)) - time * length(v)) < 1e-9);
    near(velocityTo(x, radius, to, time), v, 1e-9);
  }
  assert.deepEqual(arrowEnds([1, 2, 3], 1, [0, 0, 0], 5), { from: [1, 2, 3], to: [1, 2, 3] });
  assert.deepEqual(velocityTo([1, 2, 3], 1, [1, 2, 3], 5), [0, 0, 0]);
});

test("numbers of a kind have their points below one another", () => {
  assert.deepEqual([0.1, -12.34567, 0, -0.00001].map((value) => aligned(value, 20)), ["0.10", "−12.35", "0.00", "0.00"]);
  assert.equal(aligned(250, 500), "250.0");
  assert.equal(aligned(2e-9, 1e-9), "2 × 10⁻⁹");
});
