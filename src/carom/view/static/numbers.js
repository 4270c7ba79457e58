/** Numbers as people read them. */

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** @param {number} power */
const superscript = (power) =>
  (power < 0 ? "⁻" : "") + [...String(Math.abs(power))].map((d) => SUPERSCRIPTS[Number(d)]).join("");

/** Groups of three with thin spaces: 3 141 592. @param {number} value */
export const count = (value) =>
  Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, "\u202f");

/**
 * With `digits` digits that count; powers of ten outside 0.001 … 100 000.
 * @param {number} value @param {number} [digits]
 */
export function short(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const sign = value < 0 ? "−" : "";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, power] = size.toExponential(digits - 1).split("e");
    return `${sign}${Number(mantissa)} × 10${superscript(Number(power))}`;
  }
  const whole = Math.floor(Math.log10(size)) + 1;
  const text = size.toFixed(Math.max(0, digits - whole));
  return sign + (text.includes(".") ? text.replace(/\.?0+$/, "") : count(Number(text)));
}

/** A power of ten: 3 × 10⁻¹⁵. @param {number} value */
export function scientific(value) {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return "–";
  const [mantissa, power] = Math.abs(value).toExponential(0).split("e");
  return `${mantissa} × 10${superscript(Number(power))}`;
}

/** A share of something: in percent, or as a power of ten where it is tiny. @param {number} value */
export const part = (value) =>
  Math.abs(value) < 1e-3 ? scientific(value) : `${short(100 * Math.abs(value), 2)} %`;

/** A multiple of the normal speed: 0.05×, 1×, 12×. @param {number} speed */
export const multiple = (speed) => `${short(speed, 2)}×`;
