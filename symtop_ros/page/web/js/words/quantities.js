// Quantities as the page writes and reads them: numbers, and angles in rad or degrees.

import { find } from "../controls/document.js";
import { localize, writeNumber } from "./numbers.js";
import { UNITS } from "./units.js";

export const inDegrees = () => find("unit", HTMLSelectElement).value === "deg";

/** An angle in the unit of the page. @param {number} value in rad */
export const toUnit = (value) => (inDegrees() ? (value * 180) / Math.PI : value);

export const angleUnit = () => (inDegrees() ? "\u00b0" : "rad");

/** The unit in which the page shows a quantity. @param {string} unit of SI */
export const nameUnit = (unit) => (unit === "rad" ? angleUnit() : unit);

/** A name with the unit of its field, unless it has it. @param {string} name @param {string} unit of SI */
export const addUnit = (name, unit) => (unit === "rad" ? `${name} (${angleUnit()})` : name);

/**
 * A number with some significant digits, without zeros at its end.
 * @param {number | null | undefined} value @param {number} digits
 */
export const shorten = (value, digits = 4) =>
  value === null || value === undefined || Number.isNaN(value)
    ? ""
    : localize(String(Number(value.toPrecision(digits))));

/** An angle in the unit of the page, with its unit. @param {number} value in rad */
export const writeAngle = (value) => {
  const shown = toUnit(value);
  return `${writeNumber(Math.round(shown * 1e4) / 1e4, inDegrees() ? "1f" : "3f")} ${angleUnit()}`;
};

const DEGREE = Math.PI / 180;
const LIMIT_DIGITS = 5;
/** @typedef {{[unit: string]: number}} Units that may be typed, each in that of the field */
const QUOTIENT = /^([+-]?)([^/]*?)(?:\s*\/\s*(\d+\.?\d*))?$/;
const FACTOR = /^(\d+\.?\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?)?\s*(pi)?$/;
const THOUSANDS = /(?<![\d.,])([1-9]\d{0,2})([.,])(\d{3})(?![\d.,])/;

/**
 * The two numbers that a text can mean by a separator of thousands; null if it is none in the
 * language of the page. A zero before it leaves one meaning.
 * @param {string} text @returns {{whole: string, part: string} | null}
 */
export const findReadings = (text) => {
  const [, first, separator, rest] = text.match(THOUSANDS) ?? [];
  if (first === undefined || separator === localize(".")) return null;
  return { whole: `${first}${rest}`, part: localize(`${first}.${rest}`) };
};

/** A factor as it is typed; NaN if it is none. @param {string} text */
const parseFactor = (text) => {
  const [, size, pi] = text.trim().match(FACTOR) ?? [];
  return size || pi ? Number(size ?? 1) * (pi ? Math.PI : 1) : NaN;
};

/** In one rounding where it can be, as units.py does. @param {number} value @param {number} size of its unit */
const convert = (value, size) => (size >= 1 || (1 / size) % 1 ? value * size : value / (1 / size));

/**
 * A limit in the unit of the page, without it, in few digits, rounded to one side.
 * @param {number} limit in SI @param {1 | -1} side
 * @param {string} unit of SI @param {number} digits
 */
export const writeRounded = (limit, side, unit, digits) => {
  const size = unit === "rad" && inDegrees() ? DEGREE : 1;
  const near = Number(convert(limit, 1 / size).toPrecision(digits));
  const place = Math.floor(Math.log10(Math.abs(near))) - digits + 1;
  const isAllowed = !Number.isFinite(near) || side * (convert(near, size) - limit) >= 0;
  const kept = isAllowed ? near : Number((near + side * 10 ** place).toPrecision(digits));
  return localize(String(kept));
};

/**
 * A limit in the unit of the field that it bounds, with the unit, rounded to the side that is allowed:
 * one that is typed in again is not refused.
 * @param {number} limit in SI @param {1 | -1} side of what is allowed
 * @param {string} unit of SI @param {number} digits
 */
export const writeLimit = (limit, side, unit, digits = LIMIT_DIGITS) => {
  const shown = nameUnit(unit);
  return `${writeRounded(limit, side, unit, digits)}${shown === "\u00b0" ? "" : " "}${shown}`;
};

/**
 * A number as it is typed, with a unit or without: 0.5, 1e-3, pi/4, 45*2*pi, 30°, 0.6 rad, 2700 rpm,
 * 2e-4 kg m^2; NaN if it is none. An angle without a unit is in that of the page; a multiple of pi is
 * in rad.
 * @param {string} text @param {Units} units @param {boolean} isInDegrees an angle without a unit
 */
export const parseQuantity = (text, units, isInDegrees = inDegrees()) => {
  const write = (/** @type {string} */ each) => each.toLowerCase().replace("^2", "\u00b2");
  const plain = write(text.trim())
    .replace("\u2212", "-")
    .replaceAll(",", ".")
    .replaceAll("\u03c0", "pi");
  const fitting = Object.keys(units).filter((each) => plain.endsWith(write(each)));
  const unit = fitting.sort((one, other) => other.length - one.length)[0]; // "mm" is no "m"
  const number = plain.slice(0, plain.length - (unit ?? "").length).trim();
  const [, sign, factors = "", part = "1"] = number.match(QUOTIENT) ?? [];
  const size = factors.split("*").reduce((product, each) => product * parseFactor(each), 1);
  const value = (sign === "-" ? -size : size) / Number(part);
  if (unit) return convert(value, units[unit]);
  return units === UNITS.rad && isInDegrees && !factors.includes("pi") ? value * DEGREE : value;
};

const LITERAL =
  /^[-+]?(\d*)(?:[.,](\d*))?(?:e([-+]?\d+))?((?![\d.,])(?!\s*(?:[*/]|pi|\u03c0)).*)$/i;

/**
 * Half a unit of the last digit of a number as it is typed, in the same unit: "5e-2 s" of "57.6 s". Null
 * of products, quotients and multiples of pi, which have no last digit.
 * @param {string} text @returns {string | null}
 */
export const halveLastDigit = (text) => {
  const plain = text.trim().replace("\u2212", "-");
  const [, whole, decimals = "", exponent = "0", unit] = plain.match(LITERAL) ?? [];
  if (!whole && !decimals) return null;
  return `5e${Number(exponent) - decimals.length - 1}${unit}`;
};
