// Twin of words/templates.py: how a record becomes text, by the templates of the page's language.

import { MOST_DIGITS, setPoint, writeNumber } from "./numbers.js";

/** @typedef {"radians" | "degrees"} Variant */
/** @typedef {{[name: string]: any}} Fields */

const PLACEHOLDER = / ?\{([\w,]+)(?::(\w+))?\}/g;

/** @type {{[key: string]: string}} */
let templates = {};
let plurals = new Intl.PluralRules("en");

/**
 * Take all words from these templates of a language from now on.
 * @param {{[key: string]: string}} chosen @param {string} language
 */
export const setTemplates = (chosen, language) => {
  templates = chosen;
  plurals = new Intl.PluralRules(language);
  setPoint(chosen.point);
};

/** @param {string} key */
export const isKnown = (key) => key in templates;

/** The value of a field, or the numbers of several. @param {string} names @param {Fields} record */
const pick = (names, record) =>
  names.includes(",") ? names.split(",").flatMap((name) => record[name]) : record[names];

/**
 * A record as text, or the text of a key.
 * @param {string} name of the template, without the kind of the record
 * @param {Fields} record
 * @param {Variant} variant
 * @returns {string}
 */
export const phrase = (name, record = {}, variant = "radians") =>
  fill(record.kind ? `${name}.${record.kind}` : name, record, variant);

/** @param {string} key @param {Variant} variant */
const find = (key, variant) => templates[`${key}@${variant}`] ?? templates[key];

/** @param {string} key @param {Fields} record @param {Variant} variant @returns {string} */
const fill = (key, record, variant) =>
  find(key, variant).replace(PLACEHOLDER, (whole, name, form) => {
    const text = writeValue(name, pick(name, record), form ?? "", record, variant);
    return text && whole.startsWith(" ") ? ` ${text}` : text;
  });

/**
 * @param {string} name
 * @param {any} value
 * @param {string} form
 * @param {Fields} record
 * @param {Variant} variant
 * @returns {string}
 */
const writeValue = (name, value, form, record, variant) => {
  if (value === null || value === undefined) return "";
  if (typeof value === "boolean") return fill(`${form}.${value}`, record, variant);
  if (typeof value === "number")
    return form in templates ? count(form, value, variant) : writeNumber(value, form);
  if (typeof value === "string") return form ? fill(`${form}.${value}`, record, variant) : value;
  if (Array.isArray(value)) return writeSeveral(name, value, form, record, variant);
  return phrase(form || name, value, variant);
};

/** So many of something. @param {string} form @param {number} value @param {Variant} variant */
const count = (form, value, variant) => {
  // By the plural rules alone French would have "une fois" for 1.5 as well.
  const keys = [value === 1 ? `${form}.once` : "", `${form}.${plurals.select(value)}`];
  return fill(keys.find((each) => each in templates) ?? form, { 0: value }, variant);
};

/**
 * @param {string} name
 * @param {any[]} values
 * @param {string} form
 * @param {Fields} record
 * @param {Variant} variant
 */
const writeSeveral = (name, values, form, record, variant) => {
  if (form in templates && values.every((each) => typeof each === "number"))
    return fillNumbers(form, values, variant);
  const texts = values.map((each) => writeValue(name, each, form, record, variant));
  return texts.join(templates[`${form}.join`] ?? templates.join);
};

/** @param {string} key @param {number[]} values @param {Variant} variant */
const fillNumbers = (key, values, variant) => {
  const template = find(key, variant);
  const places = [...template.matchAll(PLACEHOLDER)];
  const write = (/** @type {number} */ more) =>
    places.map(([, place, form]) => writeNumber(values[Number(place)], form, more));
  const tries = Array.from({ length: MOST_DIGITS }, (_, more) => write(more));
  const tell = (/** @type {string[]} */ texts) => new Set(texts).size;
  // The shortest of those that tell most numbers apart.
  const texts = tries.reduce((best, each) => (tell(each) > tell(best) ? each : best));
  if (tell(texts) === 1 && `${key}.same` in templates)
    return fill(`${key}.same`, { ...values }, variant);
  return template.replace(PLACEHOLDER, (whole) => whole.split("{")[0] + texts.shift());
};
