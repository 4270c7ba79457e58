/** From the place of a slider to a number and back, and round numbers for the ends of scales. */

const PLACES = 400; // of a slider, where the number itself does not set them

/**
 * @typedef {object} Range
 * @property {number} low
 * @property {number} high
 * @property {boolean} [log] equal steps are equal factors
 * @property {boolean} [whole] whole numbers only
 */

/** How many places the slider of a range has. @param {Range} range */
export function places({ low, high, log, whole }) {
  return whole && !log && high - low <= PLACES ? Math.round(high - low) : PLACES;
}

/** The number at a place, rounded so that people can read it. @param {Range} range @param {number} place */
export function valueAt(range, place) {
  const { low, high, log, whole } = range;
  const last = places(range);
  if (place <= 0) return low;
  if (place >= last) return high;
  const share = place / last;
  const value = log ? low * (high / low) ** share : low + (high - low) * share;
  // A step of the slider moves about the third digit: more would be noise.
  const rounded = log ? Number(value.toPrecision(whole ? 2 : 3)) : tidy(value, (high - low) / last);
  const limited = Math.min(high, Math.max(low, rounded));
  return whole ? Math.round(limited) : limited;
}

/** The place of a number, at an end where it lies beyond. @param {Range} range @param {number} value */
export function placeOf(range, value) {
  const { low, high, log } = range;
  if (!(value > low)) return 0;
  if (value >= high) return places(range);
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(share * places(range));
}

/** `value` with no more decimals than steps of `step` need. @param {number} value @param {number} step */
function tidy(value, step) {
  const decimals = Math.max(0, Math.min(12, Math.ceil(-Math.log10(step) + 0.5)));
  return Number(value.toFixed(decimals));
}

/** The smallest of 1, 2, 5, 10, 20 … that is not below `value`. @param {number} value */
export function roundUp(value) {
  if (!(value > 1)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value) ?? 10 * power;
}
