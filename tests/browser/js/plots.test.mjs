// The parts of the plots that need no page: memory, axes, rates, and what they say.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { roundStep, span, tickLabel, ticks } = await import(`${folder}chart.js`);
const { apart, briefly, measured } = await import(`${folder}plots.js`);
const { Speeds, freeAxes, verdict } = await import(`${folder}speeds.js`);
const { Jumps, RateMeter, Trace, boxVolume, enskog } = await import(`${folder}traces.js`);

const near = (value, expected, relative = 1e-12) =>
  assert.ok(Math.abs(value - expected) <= relative * Math.abs(expected), `${value}, not ${expected}`);

test("ticks are few and round, without rounding errors", () => {
  assert.deepEqual(ticks(0, 1, 3).values, [0, 0.5, 1]);
  assert.deepEqual(ticks(-0.31, 0.32, 4).values, [-0.2, 0, 0.2]);
  assert.deepEqual(ticks(0, 0.3, 3).values, [0, 0.1, 0.2, 0.3]);
  assert.deepEqual(ticks(1234, 1271, 4).values, [1240, 1250, 1260, 1270]);
  for (const [low, high] of [[0, 3e-9], [-7e12, 2e12], [99.9991, 99.9997], [0, 1]]) {
    const { values, step } = ticks(low, high, 5);
    assert.ok(values.length >= 2 && values.length <= 8, `${values}`);
    for (const value of values) assert.ok(low - step * 1e-6 <= value && value <= high + step * 1e-6);
  }
  assert.equal(roundStep(0.021), 0.02);
  assert.equal(roundStep(0), 1);
});

test("labels have the digits their neighbours need", () => {
  assert.equal(tickLabel(0.3, 0.1), "0.3");
  assert.equal(tickLabel(-0.25, 0.05), "−0.25");
  assert.equal(tickLabel(20, 5), "20");
  assert.equal(tickLabel(12000, 500), "12\u202f000");
  assert.equal(tickLabel(2e-7, 1e-7), "2 × 10⁻⁷");
  assert.equal(tickLabel(0, 1), "0");
});

test("an axis holds its values, leaves out NaN, and is never empty", () => {
  const { low, high } = span([[1, NaN, 3]], {});
  assert.ok(low < 1 && high > 3 && high < 3.5);
  assert.equal(span([[2, 3]], { zero: true }).low, 0);
  assert.equal(span([[-2, -3]], { zero: true }).high, 0);
  const flat = span([[5, 5]], { least: 2 });
  assert.ok(flat.high - flat.low > 2);
  for (const columns of [[], [[]], [[0, 0]], [[NaN]], [[7, 7]]]) {
    const axis = span(columns);
    assert.ok(axis.high > axis.low && Number.isFinite(axis.high - axis.low));
  }
});

test("a trace keeps the newest rows in fixed memory", () => {
  const trace = new Trace(2, 5);
  const memory = trace.rows;
  for (let k = 0; k < 12; k++) trace.push(k, 10 * k);
  assert.equal(trace.rows, memory);
  assert.deepEqual([...trace.column(0)], [7, 8, 9, 10, 11]);
  assert.deepEqual([...trace.column(1)], [70, 80, 90, 100, 110]);
  assert.deepEqual([trace.start, trace.end], [7, 11]);
});

test("a jump breaks the line; a jump back also forgets what comes later", () => {
  const trace = new Trace(2, 8);
  for (let k = 0; k < 4; k++) trace.push(k, k);
  trace.cut();
  trace.cut();
  trace.push(4, 4);
  assert.deepEqual([...trace.column(1)], [0, 1, 2, 3, NaN, 4]);
  assert.equal(trace.largest(1), 4); // the break is no number
  trace.forget(1.5);
  assert.deepEqual([...trace.column(0)], [0, 1]);
  trace.forget(-1);
  trace.cut();
  assert.equal(trace.length, 0);
  const jumps = new Jumps();
  assert.deepEqual(
    [[0, 5], [0, 6], [1, 6], [1, 7], [1, 6.5]].map(([epoch, t]) => jumps.happened({ epoch, t })),
    [false, false, true, false, true],
  );
});

test("a rate is counted until it can be told, with its error", () => {
  const meter = new RateMeter();
  for (let k = 0; k <= 100; k++) meter.push({ t: k, clock: k / 50, collisions: 40 * k }, 41);
  const { rate, error } = meter.recent();
  near(rate, 40);
  near(error, Math.sqrt(40 * 91) / 91, 0.1);
  const counted = meter.trace.column(4);
  assert.ok(counted.length >= 5 && counted.every((part) => part >= 400));
  assert.deepEqual(new Set(meter.trace.column(3)), new Set([41]));
  meter.jump(50);
  assert.ok(meter.trace.end <= 50);
  assert.equal(meter.recent(), null); // nothing counted since
  const slow = new RateMeter();
  for (let k = 0; k <= 100; k++) slow.push({ t: k, clock: k / 10, collisions: k }, NaN);
  assert.deepEqual([...slow.trace.column(4)], [25, 25, 25, 25]);
  const rare = new RateMeter();
  for (let k = 0; k <= 600; k++) rare.push({ t: k, clock: k / 10, collisions: Math.floor(k / 50) }, NaN);
  assert.equal(rare.recent(), null);
});

const plane = (axis, sign, offset) => ({
  kind: 0,
  normal: [0, 1, 2].map((k) => (k === axis ? sign : 0)),
  offset,
});
const box = (side) => [0, 1, 2].flatMap((k) => [plane(k, 1, -side / 2), plane(k, -1, -side / 2)]);
const about = (more) => ({
  collide: true, period: [0, 0, 0], gravity: [0, 0, 0], walls: [], free_axes: 0, ...more,
});
const spheres = (n, more, masses = () => 1) => ({
  n,
  radius: new Float32Array(n).fill(0.5),
  mass: Float32Array.from({ length: n }, (_, i) => masses(i)),
  about: about(more),
});

test("Enskog's rate against the table of the validation references", () => {
  // n σ³ = 0.5, kT = m = σ = 1: ω = 7.682 with the exact contact value 2.167; Carnahan's and
  // Starling's is 2.160.
  const n = 4000;
  const side = (n / 0.5) ** (1 / 3);
  const exact = (7.682266 * n) / 2;
  near(enskog(spheres(n, { period: [side, side, side] })), exact, 0.004);
  near(enskog(spheres(n, { walls: box(side) })), exact, 0.004);
  // A dilute gas, from first principles: n₁ n₂ σ² π ⟨v₁₂⟩ / 2.
  const dilute = spheres(1000, { period: [100, 200, 300] });
  near(enskog(dilute), (1000 * (1000 / 6e6) * Math.PI * 4 * Math.sqrt(1 / Math.PI)) / 2, 1e-3);
});

test("Enskog's theory is shown only where it holds", () => {
  const period = [20, 20, 20];
  assert.ok(enskog(spheres(100, { period })) > 0);
  assert.ok(Number.isNaN(enskog(spheres(100, { period }, (i) => 1 + (i % 2)))));
  assert.ok(Number.isNaN(enskog(spheres(100, { period, collide: false }))));
  assert.ok(Number.isNaN(enskog(spheres(100, { period: [20, 20, 0] }))));
  assert.ok(Number.isNaN(enskog(spheres(100, { walls: [{ kind: 1, normal: [0, 0, 0], offset: 9 }] }))));
  assert.ok(Number.isNaN(enskog(spheres(100, { period: [4, 4, 5] })))); // a crystal
  near(boxVolume(about({ period: [2, 3, 0], walls: [plane(2, 1, -1), plane(2, -1, -4)] })), 30);
});

test("axes that keep momentum", () => {
  assert.deepEqual(freeAxes(about({ free_axes: 3 })), [0, 1, 2]);
  assert.deepEqual(freeAxes(about({ free_axes: 2, walls: box(2).slice(4) })), [0, 1]);
  assert.deepEqual(freeAxes(about({ free_axes: 2, gravity: [0, -1, 0] })), [0, 2]);
  assert.deepEqual(freeAxes(about({ free_axes: 1, walls: [{ kind: 2, normal: [0, 0, 0], offset: 3 }] })), [2]);
  assert.deepEqual(freeAxes(about({ walls: box(2) })), []);
  assert.deepEqual(freeAxes(about({ free_axes: 0 })), []); // a fixed sphere
});

/** Uniform numbers from 0 to 1, the same every time. */
function random(seed) {
  let state = BigInt(seed) + 0x9e3779b97f4a7c15n;
  return () => {
    state = (state * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn;
    return (Number(state >> 11n) + 0.5) / 2 ** 53;
  };
}
const normal = (next) => Math.sqrt(-2 * Math.log(next())) * Math.cos(2 * Math.PI * next());

/** A keyframe of an equilibrium, after so many collisions of each sphere. */
function frame(scene, next, perSphere, more = {}) {
  const velocity = Float32Array.from({ length: 3 * scene.n }, (_, k) => {
    const mass = scene.mass[Math.floor(k / 3)];
    return Number.isFinite(mass) ? normal(next) / Math.sqrt(mass) : 0;
  });
  const free = scene.mass.filter(Number.isFinite).length;
  return { n: scene.n, epoch: 0, velocity, collisions: (perSphere * free) / 2, ...more };
}

test("speeds: equilibrium agrees, one speed for all does not, mixtures are scaled", () => {
  for (const masses of [() => 1, (i) => 1 + 9 * (i % 2), (i) => (i === 7 ? Infinity : 2)]) {
    const scene = spheres(600, {}, masses);
    const speeds = new Speeds();
    speeds.setScene(scene);
    const good = speeds.histogram(frame(scene, random(1), 0));
    assert.equal(good.opinion, "agrees", verdict(good, 600));
    assert.match(verdict(good, 600), /^Agrees with Maxwell–Boltzmann: χ²\/df\s=\s[\d.]+, p\s=\s0\.\d+\.$/);
    assert.equal(good.scaled, masses(1) === 10);
    near(good.bars.reduce((sum, part) => sum + part * good.width, 0), 1, 0.01);
    const one = frame(scene, random(1), 0);
    one.velocity.forEach((_, k) => (one.velocity[k] = k % 3 === 0 && scene.mass[k / 3] < 20 ? 1 : 0));
    const bad = speeds.histogram(one);
    assert.equal(bad.opinion, "not");
    assert.match(verdict(bad, 600), /^Not yet Maxwell–Boltzmann: .*p\s<\s0\.001\.$/);
  }
});

test("speeds: the axis is the real speed where masses are equal", () => {
  const scene = spheres(1000, {}, () => 4);
  const speeds = new Speeds();
  speeds.setScene(scene);
  const { law, bars, width } = speeds.histogram(frame(scene, random(3), 0));
  const peak = law.x[law.y.indexOf(Math.max(...law.y))];
  near(peak, Math.sqrt(2 / 4), 0.05); // √(2kT/m)
  near(width * bars.length, 4.5 / 2, 0.05);
});

test("few spheres: samples gather, four collisions of each apart, and the start is forgotten", () => {
  const scene = spheres(6, {});
  const speeds = new Speeds();
  speeds.setScene(scene);
  const next = random(4);
  const start = speeds.histogram(frame(scene, next, 0));
  assert.equal(start.opinion, "collecting");
  assert.equal(verdict(start, 6), "Collecting: 6 of 40 independent speeds.");
  for (let c = 0; c <= 12; c += 0.5) speeds.offer(frame(scene, next, c));
  assert.equal(speeds.histogram(frame(scene, next, 12)).samples, 6 + 6); // 8 and now; not 0 and 4
  for (let c = 12.5; c <= 4000; c += 0.5) speeds.offer(frame(scene, next, c));
  const late = speeds.histogram(frame(scene, next, 4000));
  assert.ok(late.samples > 1900 && late.samples <= 2006, `${late.samples}`);
  assert.equal(late.opinion, "agrees", verdict(late, 6));
  assert.match(verdict(late, 6), /the exact law of 6 spheres/);
  assert.ok(late.maxwell !== null);
  const again = speeds.histogram(frame(scene, next, 4000, { epoch: 1 }));
  assert.equal(again.samples, 6);
});

test("speeds: what cannot be judged is said", () => {
  const judge = (scene, at) => {
    const speeds = new Speeds();
    speeds.setScene(scene);
    const result = speeds.histogram(at ?? frame(scene, random(2), 0));
    return [result.opinion, verdict(result, scene.n)];
  };
  const rest = spheres(50, {});
  assert.equal(judge(rest, { ...frame(rest, random(1), 0), velocity: new Float32Array(150) })[0], "still");
  assert.match(judge(spheres(300, { collide: false }))[1], /ideal gas/);
  assert.equal(judge(spheres(1, {}))[0], "single");
  assert.equal(judge(spheres(2, { free_axes: 3 }))[0], "single");
  assert.equal(judge(spheres(3, {}, () => Infinity))[0], "still");
});

test("two spheres share one number: one of them counts", () => {
  const scene = spheres(2, {}, (i) => 1 + i);
  const speeds = new Speeds();
  speeds.setScene(scene);
  const next = random(8);
  for (let c = 0; c <= 9000; c += 4) speeds.offer(frame(scene, next, c));
  const result = speeds.histogram(frame(scene, next, 9000));
  assert.ok(result.samples > 1000);
  assert.equal(result.opinion, "agrees", verdict(result, 2));
});

test("a hundred thousand spheres are looked at in part, and quickly", () => {
  const scene = spheres(100000, {}, (i) => 1 + (i % 2));
  const speeds = new Speeds();
  speeds.setScene(scene);
  const now = frame(scene, random(6), 0);
  const result = speeds.histogram(now);
  assert.equal(result.samples, 20000);
  assert.equal(result.opinion, "agrees", verdict(result, 100000));
  const times = Array.from({ length: 15 }, () => {
    const before = performance.now();
    speeds.histogram(now);
    return performance.now() - before;
  });
  assert.ok(Math.min(...times) < 5, `${times}`);
});

test("names of walls lose what they have in common", () => {
  assert.deepEqual(briefly(["x- wall of the Box", "x+ wall of the Box"]), ["x−", "x+"]);
  assert.deepEqual(briefly(["Sphere"]), ["Sphere"]);
  assert.deepEqual(briefly(["Plane", "Sphere", "Plane"]), ["Plane 1", "Sphere", "Plane 3"]);
  assert.deepEqual(briefly(["side wall of it", "wall of it"]), ["side wall", "wall"]);
  assert.deepEqual(briefly([]), []);
});

test("numbers in words", () => {
  assert.equal(measured(47.31, 0.92), "47.3 ± 0.9");
  assert.equal(measured(12345, 120), "12\u202f345 ± 120");
  assert.equal(apart(103, 100), "3.0 % above");
  assert.equal(apart(80, 100), "20 % below");
  assert.equal(apart(100.2, 100), "Within 0.5 % of");
  assert.equal(apart(103, 100, 2), "Agrees with");
});
