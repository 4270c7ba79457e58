// Distributions against known values, and verdicts on samples whose law is known.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { SpeedLaw, betaShare, chiSquareTail, compare, gammaTail, logGamma, maxwell, suitableBins, tally } =
  await import(`${folder}statistics.js`);

const near = (value, expected, relative = 1e-12) =>
  assert.ok(Math.abs(value - expected) <= relative * Math.abs(expected), `${value}, not ${expected}`);

/** Uniform numbers from 0 to 1, the same every time. */
function random(seed) {
  let state = BigInt(seed) + 0x9e3779b97f4a7c15n;
  return () => {
    state = (state * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn;
    return (Number(state >> 11n) + 0.5) / 2 ** 53;
  };
}

/** Normal numbers, by G. Box and M. Muller. */
const normal = (next) => Math.sqrt(-2 * Math.log(next())) * Math.cos(2 * Math.PI * next());

/**
 * Speeds of one moment in units of √(kT/m), drawn uniformly from all motions with one energy and,
 * along the first axes, no momentum.
 */
function moment(next, masses, axes) {
  const total = masses.reduce((sum, mass) => sum + mass, 0);
  const v = masses.map((mass) => [0, 1, 2].map(() => normal(next) / Math.sqrt(mass)));
  for (let k = 0; k < axes; k++) {
    const drift = v.reduce((sum, part, i) => sum + masses[i] * part[k], 0) / total;
    for (const part of v) part[k] -= drift;
  }
  const twice = v.reduce((sum, part, i) => sum + masses[i] * part.reduce((s, p) => s + p * p, 0), 0);
  const freedom = 3 * masses.length - axes;
  return v.map((part, i) => {
    const tied = total / (total - masses[i]);
    const squares = part.reduce((sum, p, k) => sum + (k < axes ? tied : 1) * p * p, 0);
    return Math.sqrt((freedom * masses[i] * squares) / twice);
  });
}

test("gamma function", () => {
  near(logGamma(0.5), Math.log(Math.PI) / 2);
  near(logGamma(5), Math.log(24));
  near(logGamma(101), 363.73937555556349);
  near(logGamma(1.5), Math.log(Math.sqrt(Math.PI) / 2), 1e-11);
  assert.ok(Math.abs(logGamma(1)) < 1e-13);
});

test("incomplete gamma function, on both sides of where the methods change", () => {
  for (const x of [0.1, 1, 1.9, 2.1, 10, 100]) near(gammaTail(1, x), Math.exp(-x));
  for (const x of [0.5, 3.9, 4.1, 20]) {
    near(gammaTail(3, x), Math.exp(-x) * (1 + x + (x * x) / 2));
  }
  near(gammaTail(0.5, 0.5), 0.31731050786291404); // outside one standard deviation
  near(gammaTail(0.5, 2), 0.04550026389635839); // outside two
  near(gammaTail(100, 100), 0.48670120172085135);
  assert.equal(gammaTail(3, 0), 1);
});

test("chi-square against tables", () => {
  near(chiSquareTail(3.841458820694124, 1), 0.05);
  near(chiSquareTail(18.307038053275146, 10), 0.05);
  near(chiSquareTail(50.89218131151707, 30), 0.01);
  near(chiSquareTail(7, 2), Math.exp(-3.5));
  // With an even number of degrees of freedom it is a finite sum.
  let [term, sum] = [1, 0];
  for (let k = 0; k < 10; term *= 200 / ++k) sum += term;
  near(chiSquareTail(400, 20), Math.exp(-200) * sum);
});

test("beta distribution", () => {
  for (const s of [0.01, 0.3, 0.77, 0.999]) {
    near(betaShare(s, 1, 1), s);
    near(betaShare(s, 1.5, 1), s ** 1.5);
    near(betaShare(s, 0.5, 0.5), (2 / Math.PI) * Math.asin(Math.sqrt(s)), 1e-11);
    near(betaShare(s, 1.5, 40) + betaShare(1 - s, 40, 1.5), 1);
  }
  assert.equal(betaShare(0, 1.5, 2), 0);
  assert.equal(betaShare(1, 1.5, 2), 1);
});

test("the law of speeds: its density belongs to its shares, and its mean energy is 3/2 kT", () => {
  for (const freedom of [6, 15, 600, 300000]) {
    const law = new SpeedLaw(freedom);
    const end = Math.min(law.limit, 8);
    const steps = 40000;
    let [share, energy] = [0, 0];
    for (let k = 0; k < steps; k++) {
      const u = ((k + 0.5) * end) / steps;
      share += (law.density(u) * end) / steps;
      energy += (law.density(u) * u * u * end) / steps;
      if (k % 5000 === 4999) near(law.share(u + end / steps / 2), share, 1e-6);
    }
    near(share, 1, 1e-5);
    near(energy, 3, 1e-5);
    const edges = law.edges(9);
    edges.forEach((u, k) => near(law.share(u), (k + 1) / 9, 1e-9));
  }
});

test("the law of many spheres is Maxwell's and Boltzmann's, that of few is not", () => {
  const many = new SpeedLaw(3e6);
  const few = new SpeedLaw(15);
  for (const u of [0.3, 1, 1.7, 3, 4]) near(many.density(u), maxwell(u), 1e-4);
  assert.ok(few.density(3.4) < 0.5 * maxwell(3.4));
  assert.equal(few.density(4), 0); // more than all the energy
});

test("bins: at least five expected in each, and counts add up", () => {
  for (const n of [40, 100, 500, 2000, 20000]) {
    assert.ok(n / suitableBins(n) >= 5 && suitableBins(n) >= 8);
  }
  const edges = Float64Array.of(1, 2, 3);
  assert.deepEqual([...tally([0.5, 1, 1.5, 2.5, 9, 3], 6, edges)], [1, 2, 1, 2]);
});

/** p of many experiments, each of so many moments. */
function chances(experiments, moments, masses, axes, law = new SpeedLaw(3 * masses.length - axes)) {
  const next = random(masses.length + 1000 * axes);
  return Array.from({ length: experiments }, () => {
    const u = Array.from({ length: moments }, () => moment(next, masses, axes)).flat();
    return compare(law, u, u.length, 1).p;
  });
}

for (const [n, axes, moments] of [[3, 3, 300], [6, 0, 20], [6, 3, 100], [6, 1, 60], [40, 3, 10], [500, 0, 1]]) {
  test(`true samples: p is uniform (${n} spheres, momentum kept along ${axes} axes)`, () => {
    const masses = Array.from({ length: n }, (_, i) => 1 + (i % 3));
    const p = chances(250, moments, masses, axes).sort((a, b) => a - b);
    // A. Kolmogorov's distance; 1.95/√n is exceeded once in a thousand times.
    const worst = Math.max(...p.map((part, k) => Math.abs(part - (k + 0.5) / p.length)));
    assert.ok(worst < 1.95 / Math.sqrt(p.length), `${worst}`);
    assert.ok(p.filter((part) => part < 0.01).length <= 9);
  });
}

test("wrong samples: all at one speed", () => {
  const law = new SpeedLaw(1497);
  assert.ok(compare(law, new Float64Array(500).fill(Math.sqrt(3)), 500, 1).p < 1e-12);
});

test("wrong law: Maxwell's and Boltzmann's for six spheres, once there are enough samples", () => {
  const masses = Array(6).fill(1);
  const many = new SpeedLaw(3e6);
  assert.ok(Math.max(...chances(20, 333, masses, 3, many)) < 1e-3);
});

test("wrong temperature and wrong direction: no hidden slack", () => {
  const next = random(5);
  const u = Array.from({ length: 2000 }, () => Math.hypot(normal(next), normal(next), normal(next)));
  const law = new SpeedLaw(6000);
  assert.ok(compare(law, u, 2000, 0).p > 0.001);
  assert.ok(compare(law, u.map((part) => 1.1 * part), 2000, 0).p < 1e-6);
  const flat = u.map(() => Math.hypot(normal(next), normal(next)) * Math.sqrt(1.5));
  assert.ok(compare(law, flat, 2000, 1).p < 1e-12);
});
