// Twin of the rounding in wording/templates.py: how a number is written, in every sentence.

import { Big, LONGEST } from "../physics/big.js";

const [SMALLEST_RATE, LARGEST_RATE] = [0.1, 1e5]; // rad/s; others are written with three digits

/**
 * The integer nearest to size times 10^power; the even one of two.
 * @param {number} size
 * @param {number} power
 */
const scaleToInteger = (size, power) => {
  const { mantissa, exponent } = Big.of(size, LONGEST);
  let above = mantissa * (power > 0 ? 10n ** BigInt(power) : 1n);
  let below = power < 0 ? 10n ** BigInt(-power) : 1n;
  if (exponent > 0) above <<= BigInt(exponent);
  else below <<= BigInt(-exponent);
  const whole = above / below;
  const twice = 2n * (above - whole * below);
  return twice > below || (twice === below && whole & 1n) ? whole + 1n : whole;
};

/**
 * With a number of decimals.
 * @param {number} size
 * @param {number} decimals
 */
const writeFixed = (size, decimals) => {
  const digits = String(scaleToInteger(size, decimals)).padStart(decimals + 1, "0");
  const place = digits.length - decimals;
  return decimals ? `${digits.slice(0, place)}.${digits.slice(place)}` : digits;
};

/**
 * With a number of significant digits: these, and the exponent of the first.
 * @param {number} size
 * @param {number} count
 * @returns {[string, number]}
 */
const findDigits = (size, count) => {
  if (size === 0) return ["0".repeat(count), 0];
  let exponent = Math.floor(Math.log10(size));
  for (;;) {
    const digits = String(scaleToInteger(size, count - 1 - exponent));
    if (digits.length === count) return [digits, exponent];
    exponent += digits.length - count;
  }
};

/** @param {number} exponent */
const writeExponent = (exponent) =>
  `e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;

/** @param {string} text with a point */
const dropZeros = (text) => text.replace(/\.?0*$/, "");

/**
 * As %g of C.
 * @param {number} size
 * @param {number} count
 */
const writeGeneral = (size, count) => {
  const [digits, exponent] = findDigits(size, count);
  if (exponent < -4 || exponent >= count) {
    const text = count > 1 ? dropZeros(`${digits[0]}.${digits.slice(1)}`) : digits;
    return text + writeExponent(exponent);
  }
  if (exponent < 0) return dropZeros(`0.${"0".repeat(-exponent - 1)}${digits}`);
  const text = `${digits.slice(0, exponent + 1)}.${digits.slice(exponent + 1)}`;
  return dropZeros(text);
};

/**
 * @param {number} size
 * @param {number} decimals
 */
const writeScientific = (size, decimals) => {
  const [digits, exponent] = findDigits(size, decimals + 1);
  return `${digits[0]}.${digits.slice(1)}${writeExponent(exponent)}`;
};

const WRITERS = { f: writeFixed, g: writeGeneral, e: writeScientific };

/**
 * A number as text, in a format such as 3f, 3g, rate or 1fdeg.
 * @param {number} value
 * @param {string} form
 * @returns {string}
 */
export const writeNumber = (value, form) => {
  if (form === "rate") {
    const size = Math.abs(value);
    const isPlain = value === 0 || (SMALLEST_RATE <= size && size < LARGEST_RATE);
    return writeNumber(value, isPlain ? "2f" : "3g");
  }
  if (form.endsWith("deg")) return writeNumber((value * 180) / Math.PI, form.slice(0, -3));
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value < 0 ? "-inf" : "inf";
  const [, count, letter] = /** @type {RegExpMatchArray} */ (form.match(/^(\d+)([fge])$/));
  const text = WRITERS[/** @type {"f" | "g" | "e"} */ (letter)](Math.abs(value), Number(count));
  return value < 0 && Number(text) !== 0 ? `-${text}` : text;
};
