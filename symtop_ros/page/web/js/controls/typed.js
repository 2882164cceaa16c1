// Numbers that are typed into a list or a form, and read when its button is pressed.

import { acceptField, refuseField } from "./notices.js";
import { make } from "./document.js";
import { findReadings, inDegrees, parseQuantity, shorten, toUnit } from "../words/quantities.js";
import { UNITS } from "../words/units.js";
import { phrase } from "../words/wording.js";

const DIGITS = 15; // of an angle that is written in another unit

/**
 * An input for a number; what was said of its text is no longer so when the text has changed.
 * @param {{[name: string]: any}} properties
 */
export const makeInput = (properties) => {
  const input = make("input", { type: "text", autocomplete: "off", ...properties });
  input.addEventListener("input", () => acceptField(input));
  return input;
};

/**
 * An angle that was typed without a unit is kept when another unit is chosen, and written in it.
 * @param {HTMLInputElement} input
 */
export const convertTyped = (input) => {
  const [is, was] = [inDegrees(), !inDegrees()].map((unit) =>
    parseQuantity(input.value, UNITS.rad, unit),
  );
  if (Number.isFinite(was) && is !== was) input.value = shorten(toUnit(was), DIGITS);
};

/**
 * The number in an input, in its unit of SI; null for a text that is none, which is refused.
 * @param {HTMLInputElement} input
 * @param {string} unit of SI, or "" for none
 * @param {boolean} [isPositive] it must be
 * @returns {number | null}
 */
export const readTyped = (input, unit, isPositive = false) => {
  const typed = input.value.trim();
  const readings = findReadings(typed);
  const value = parseQuantity(typed, UNITS[unit] ?? {});
  const kind = readings ? "clear" : Number.isFinite(value) ? null : "number";
  const refusal = kind ?? (isPositive && !(value > 0) ? "positive" : null);
  acceptField(input);
  if (!refusal) return value;
  const got = typed || phrase("nothing");
  const name = input.dataset.name ?? input.ariaLabel; // a label has formulas in words
  refuseField(input, phrase("refused", { kind: refusal, name, ...readings, got }));
  return null;
};
