// Quantities as the page writes and reads them: numbers, and angles in rad or degrees.

import { find } from "../controls/document.js";
import { localize, writeNumber } from "./numbers.js";

export const inDegrees = () => find("unit", HTMLSelectElement).value === "deg";

/** An angle in the unit of the page. @param {number} value in rad */
export const toUnit = (value) => (inDegrees() ? (value * 180) / Math.PI : value);

export const angleUnit = () => (inDegrees() ? "\u00b0" : "rad");

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

const NUMBER =
  /^([+-]?)(\d+\.?\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?)?\s*\*?\s*(pi)?(?:\s*\/\s*(\d+\.?\d*))?$/;
const WITH_UNIT = /^(.*?)\s*(\u00b0|deg|degrees|rad)?$/;

/**
 * A number as it is typed, with a unit if it is an angle: 0.5, 1e-3, pi/4, 30°, 0.6 rad; NaN if it
 * is none. An angle without a unit is in that of the page; a multiple of pi is in rad.
 * @param {string} text @param {boolean} isAngle
 */
export const parseQuantity = (text, isAngle) => {
  const plain = text
    .trim()
    .toLowerCase()
    .replace("\u2212", "-")
    .replace(",", ".")
    .replace("\u03c0", "pi");
  const [, number = "", unit] = plain.match(WITH_UNIT) ?? [];
  const [, sign, size, pi, part] = number.match(NUMBER) ?? [];
  if (sign === undefined || (!size && !pi) || (unit && !isAngle)) return NaN;
  const value =
    (Number(size ?? 1) * (pi ? Math.PI : 1) * (sign === "-" ? -1 : 1)) / Number(part ?? 1);
  const isDegrees = unit ? unit !== "rad" : isAngle && inDegrees() && !pi;
  return isDegrees ? (value * Math.PI) / 180 : value;
};
