// What is said of a fit: what the record shows and whether the model holds in two sentences, the numbers with
// their deviations, and what cannot be known.

import { writeMeasured } from "./deviations.js";
import { nameUnit, toUnit } from "./quantities.js";
import { isKnown, phrase } from "./wording.js";

/** @import { Fitted } from "../fit/answer.js" */
/** @import { Value } from "../fit/values.js" */
/** @import { Unknown } from "../fit/unknown.js" */

const ZERO = 3; // deviations within which a number may be zero
/** Those of the first sentence, and what they are of the top. @type {[name: string, what: string][]} */
const MAIN = [
  ["p_psi/Ix", "p_psi"],
  ["Mgl/Ix", "weight"],
];
const SIGN = "sign of ";
const RATE = "mean_precession_rate";
const MEANT = ["p_psi/Ix", "nearness"]; // numbers that are explained
export const COLUMNS = { axis: ["x", "y", "z"], pixels: ["u", "v"] };

/** @param {string} unit of a value; an angle has that of the page */
const writeUnit = (unit) => (unit === "pixels" ? "px" : nameUnit(unit));

/** The unit of what is left of a point. @param {Fitted["kind"]} kind */
export const nameResidual = (kind) => (kind === "pixels" ? "px" : "");

/** @param {string} name of a value @returns {string} */
const writeName = (name) => {
  if (name.startsWith(SIGN))
    return phrase("fitted.sign", { name: writeName(name.slice(SIGN.length)) });
  return isKnown(`fitted.name.${name}`) ? phrase(`fitted.name.${name}`) : name;
};

/** A value with its deviation and its unit; an angle in the unit of the page. @param {Value} value */
const writeValue = ({ value, deviation, unit }) => {
  const convert = unit === "rad" ? toUnit : (/** @type {number} */ each) => each;
  return `${writeMeasured(convert(value), convert(deviation))} ${writeUnit(unit)}`.trim();
};

/** What is said of a number: that it is known, may be zero, or is not known. @param {Value} value @param {string} what */
const tellNumber = (value, what) => {
  const measured = writeValue(value);
  if (!value.is_known) return { kind: "unknown", what };
  if (Math.abs(value.value) <= ZERO * value.deviation) return { kind: "zero", what, measured };
  return {
    kind: "sized",
    what,
    measured,
    percent: (100 * value.deviation) / Math.abs(value.value),
  };
};

/** What the record shows of the top, in a sentence. @param {Fitted} fitted */
export const writeShown = ({ rows, times, values }) => {
  const numbers = MAIN.flatMap(([name, what]) =>
    values.filter((each) => each.name === name).map((each) => tellNumber(each, what)),
  );
  return phrase("fitted.shows", { rows, seconds: times[times.length - 1] - times[0], numbers });
};

/** Whether the model holds, and why not, in a sentence. @param {Fitted} fitted */
export const writeVerdict = ({ kind, verdict, reasons, sigma, outliers, order, is_flicker }) => {
  const left = sigma.map((size, k) => ({
    size,
    unit: nameResidual(kind),
    column: COLUMNS[kind][k],
  }));
  const lasting = is_flicker ? "flicker" : "lasting";
  return phrase("fitted_verdict", {
    kind: verdict,
    left,
    noise: order ? lasting : "white",
    reasons,
    out: outliers.length || null,
  });
};

/**
 * The time of one turn of the precession, which a watch checks; none of a rate that may be zero.
 * @param {Value} rate @returns {Value[]}
 */
const findPeriod = ({ name, value, deviation, ...rest }) => {
  if (name !== RATE || !rest.is_known || !(Math.abs(value) > ZERO * deviation)) return [];
  const period = (2 * Math.PI) / Math.abs(value);
  const spread = (period * deviation) / Math.abs(value);
  return [{ ...rest, name: "precession_period", value: period, deviation: spread, unit: "s" }];
};

/** Names and values of all numbers. @param {Fitted} fitted @returns {[name: string, text: string][]} */
export const listNumbers = ({ values }) =>
  values
    .flatMap((each) => [each, ...findPeriod(each)])
    .map((each) => [
      writeName(each.name),
      each.is_known ? writeValue(each) : phrase("fitted.not_known"),
    ]);

/** What the words of the table mean, of those numbers that it has. @param {Fitted} fitted */
export const writeMeanings = ({ values }) => {
  const known = MEANT.filter((name) => values.some((each) => each.name === name));
  return known.map((name) => phrase(`fitted.meaning.${name}`)).join(" ");
};

/** What a record cannot show, and why, in a sentence; of some with what settles it. @param {Unknown} unknown @param {Value[]} values */
const writeUnknown = ({ kind, names, numbers }, values) => {
  const [value, deviation] = numbers.slice(-2);
  const own = values.find(({ name }) => name === names);
  const measured = own ? writeValue(own) : writeMeasured(value, deviation);
  const record = {
    ...Object.fromEntries(numbers.map((each, k) => [`n${k}`, each])),
    names: names
      .split(/, | and /)
      .map(writeName)
      .join(", "),
    value: numbers.length > 1 ? measured : null,
    factor: kind === "together" ? writeMeasured(numbers[0], numbers[1]) : null,
  };
  const more = `fitted.remedy.${kind}`;
  return phrase(`unknown.${kind}`, record) + (isKnown(more) ? phrase(more) : "");
};

/** @param {Fitted} fitted */
export const listUnknown = ({ unknown, values }) =>
  unknown.map((each) => `${writeUnknown(each, values)}.`);

/** What this search leaves out; nothing if the record has nothing of it. @param {Fitted} fitted */
export const writeLimits = ({ limits }) =>
  limits.length ? phrase("fitted.limits", { limits: limits.map((kind) => ({ kind })) }) : "";

/** Numbers of the run that the record does not show. @param {Fitted} fitted */
export const writeAssumed = ({ assumed }) =>
  assumed.length ? phrase("fitted.assumed", { numbers: assumed }) : "";
