/** Distributions and tests: pure numbers, no page. */

const PRECISION = 1e-15;
const STEPS = 10000; // more than any fraction or series below takes
const TINY = 1e-300; // in place of a zero denominator

/** ln Γ(x) for x > 0: Stirling's series, after moving x to where it is exact. @param {number} x */
export function logGamma(x) {
  let shift = 0;
  for (; x < 12; x++) shift += Math.log(x);
  const q = 1 / (x * x);
  const series =
    (1 / 12 - q * (1 / 360 - q * (1 / 1260 - q * (1 / 1680 - q * (1 / 1188 - (q * 691) / 360360))))) /
    x;
  return (x - 0.5) * Math.log(x) - x + 0.5 * Math.log(2 * Math.PI) + series - shift;
}

/**
 * A continued fraction b₀ + a₁/(b₁ + a₂/(b₂ + …)), by Lentz's method: numerator and denominator are
 * followed as ratios, so that neither overflows.
 * @param {number} b0 @param {(k: number) => [number, number]} part aₖ and bₖ
 */
function fraction(b0, part) {
  let value = b0 || TINY;
  let above = value;
  let below = 0;
  for (let k = 1; k < STEPS; k++) {
    const [a, b] = part(k);
    below = 1 / (b + a * below || TINY);
    above = b + a / above || TINY;
    value *= above * below;
    if (Math.abs(above * below - 1) < PRECISION) break;
  }
  return value;
}

/** Q(a, x), the upper incomplete gamma function over Γ(a). @param {number} a @param {number} x */
export function gammaTail(a, x) {
  if (!(x > 0)) return 1;
  const factor = Math.exp(a * Math.log(x) - x - logGamma(a));
  if (x > a + 1) {
    return factor / fraction(x + 1 - a, (k) => [k * (a - k), x + 2 * k + 1 - a]);
  }
  let term = 1 / a;
  let sum = term;
  for (let k = 1; k < STEPS && term > sum * PRECISION; k++) {
    term *= x / (a + k);
    sum += term;
  }
  return 1 - factor * sum;
}

/** Chance that chi-square of `df` degrees of freedom exceeds `x`. @param {number} x @param {number} df */
export const chiSquareTail = (x, df) => gammaTail(df / 2, x / 2);

/** @param {number} a @param {number} b */
const logBeta = (a, b) => logGamma(a) + logGamma(b) - logGamma(a + b);

/**
 * The beta distribution: chance that a variable with density ∝ s^(a-1) (1-s)^(b-1) is below `s`.
 * @param {number} s @param {number} a @param {number} b @returns {number}
 */
export function betaShare(s, a, b) {
  if (!(s > 0)) return 0;
  if (s >= 1) return 1;
  // The fraction converges fast only below about the mean.
  if (s > (a + 1) / (a + b + 2)) return 1 - betaShare(1 - s, b, a);
  const factor = Math.exp(a * Math.log(s) + b * Math.log1p(-s) - logBeta(a, b));
  const below = fraction(1, (k) => {
    const j = k >> 1;
    const there = a + 2 * j;
    const over = k % 2 === 0 ? j * (b - j) : -(a + j) * (a + b + j);
    return [(over * s) / (k % 2 === 0 ? (there - 1) * there : there * (there + 1)), 1];
  });
  return factor / (a * below);
}

/**
 * How fast a sphere is where `freedom` degrees of freedom share a fixed energy, in units of
 * √(kT/m), with kT = 2E/f: u² / f has a beta distribution. It is exact for every number of spheres,
 * and Maxwell's and Boltzmann's law in the limit of many.
 */
export class SpeedLaw {
  /** @param {number} freedom more than 3 */
  constructor(freedom) {
    this.freedom = freedom;
    this.rest = (freedom - 3) / 2;
    this.norm = logBeta(1.5, this.rest);
    /** The speed nobody exceeds: one sphere has all the energy. */
    this.limit = Math.sqrt(freedom);
    /** @type {Float64Array | null} */ this.known = null;
  }

  /** @param {number} u */
  density(u) {
    const s = (u * u) / this.freedom;
    if (!(u > 0) || s >= 1) return 0;
    const log = 0.5 * Math.log(s) + (this.rest - 1) * Math.log1p(-s) - this.norm;
    return ((2 * u) / this.freedom) * Math.exp(log);
  }

  /** Chance to be slower. @param {number} u */
  share(u) {
    return betaShare((u * u) / this.freedom, 1.5, this.rest);
  }

  /** The inner edges of `bins` bins that are equally likely. @param {number} bins @returns {Float64Array} */
  edges(bins) {
    if (this.known?.length === bins - 1) return this.known;
    this.known = Float64Array.from({ length: bins - 1 }, (_, k) => this.#quantile((k + 1) / bins));
    return this.known;
  }

  /** By halving: slow, certain, and done once. @param {number} share */
  #quantile(share) {
    let low = 0;
    let high = Math.min(this.limit, 40);
    for (let k = 0; k < 50; k++) {
      const middle = (low + high) / 2;
      if (this.share(middle) < share) low = middle;
      else high = middle;
    }
    return (low + high) / 2;
  }
}

/** Maxwell's and Boltzmann's density of u = v √(m/kT). @param {number} u */
export const maxwell = (u) => Math.sqrt(2 / Math.PI) * u * u * Math.exp((-u * u) / 2);

const MOST_BINS = 30;
const EXPECTED = 5; // in each bin: with fewer, chi-square is not the law of the sum

/** How many bins suit `n` samples: H. Mann and A. Wald's growth with n. @param {number} n */
export const suitableBins = (n) =>
  Math.max(2, Math.min(MOST_BINS, Math.floor(n / EXPECTED), Math.floor(2 * n ** 0.4)));

/** How many of the values fall between the edges. @param {ArrayLike<number>} values @param {number} n @param {Float64Array} edges */
export function tally(values, n, edges) {
  const counts = new Float64Array(edges.length + 1);
  for (let i = 0; i < n; i++) {
    let low = 0;
    let high = edges.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[i] < edges[middle]) high = middle;
      else low = middle + 1;
    }
    counts[low]++;
  }
  return counts;
}

/**
 * @typedef {object} Fit
 * @property {number} ratio chi-square over its degrees of freedom
 * @property {number} p chance of a worse fit if the law is true
 *
 * Do the values follow the law? Pearson's chi-square over equally likely bins.
 * @param {SpeedLaw} law @param {ArrayLike<number>} values @param {number} n
 * @param {number} [taken] degrees of freedom taken by what was fitted to the same values
 * @returns {Fit}
 */
export function compare(law, values, n, taken = 0) {
  const bins = suitableBins(n);
  const expected = n / bins;
  let sum = 0;
  for (const count of tally(values, n, law.edges(bins))) sum += (count - expected) ** 2 / expected;
  const df = bins - 1 - taken;
  return { ratio: sum / df, p: chiSquareTail(sum, df) };
}
