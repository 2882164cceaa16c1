// Numbers that are typed into a list or a form, and read when its button is pressed.

import { refuse } from "./notices.js";
import { findReadings, parseQuantity } from "../words/quantities.js";
import { UNITS } from "../words/units.js";
import { phrase } from "../words/wording.js";

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
  input.setAttribute("aria-invalid", String(Boolean(refusal))); // empty it would mean false
  if (!refusal) return value;
  const got = typed || phrase("nothing");
  refuse(phrase("refused", { kind: refusal, name: input.ariaLabel, ...readings, got }));
  return null;
};
