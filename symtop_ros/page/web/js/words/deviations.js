// Twin of base/measured.py: a number with its standard deviation; both end at the same decimal place.

import { writeNumber, writeRounded } from "./numbers.js";

const DIGITS = 2; // of a deviation: the Guide to the Expression of Uncertainty in Measurement, 7.2.6
const [SMALLEST, LARGEST] = [-5, 9]; // exponents; beyond them a power of ten is easier to read

/** The exponent of a number that is rounded to seven digits. @param {number} value */
const findExponent = (value) => (value ? Number(value.toExponential(6).split("e")[1]) : -999);

/** A whole number of steps of 10^last that is nearest, and even if two are. @param {number} value @param {number} last > 0 */
const roundTo = (value, last) => {
  const [size, step] = [Math.abs(value), 10 ** last];
  const whole = Math.floor(size);
  const over = (whole % step) + (size - whole); // exact, as numbers are below 1e9
  const base = whole - (whole % step);
  const isUp = over === step / 2 ? (base / step) % 2 === 1 : over > step / 2;
  return Math.sign(value) * (base + (isUp ? step : 0));
};

/** Rounded to 10^last, in a power of ten. @param {number} value @param {number} last @param {number} power */
const round = (value, last, power) => {
  if (power < last) return writeRounded(roundTo(value, last), 0);
  return writeRounded(power ? value / Number(`1e${power}`) : value, power - last);
};

/**
 * A value and its deviation, which has two digits. Without a deviation (zero, infinite or not a number) the
 * value has six.
 * @param {number} value @param {number} deviation @returns {[string, string]}
 */
export const writeParts = (value, deviation) => {
  if (!(deviation > 0 && Number.isFinite(deviation) && Number.isFinite(value)))
    return [writeNumber(value, "6g"), writeNumber(deviation, "2g")];
  const rounded = Number(deviation.toExponential(DIGITS - 1)); // rounding may carry: 0.0996 is 0.10
  const last = findExponent(rounded) - (DIGITS - 1);
  const first = Math.max(findExponent(value), findExponent(deviation));
  const power = first >= SMALLEST && first < LARGEST ? 0 : first;
  const sign = power < 0 ? "-" : "+";
  const end = power ? `e${sign}${String(Math.abs(power)).padStart(2, "0")}` : "";
  const [number, spread] = [value, deviation].map((each) => round(each, last, power) + end);
  return [number, spread];
};

/** A value with its deviation as one text, in the language of the page. @param {number} value @param {number} deviation */
export const writeMeasured = (value, deviation) => {
  const [number, spread] = writeParts(value, deviation);
  return `${number} \u00b1 ${spread}`;
};
