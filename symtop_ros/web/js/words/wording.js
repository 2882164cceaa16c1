// Twin of wording/templates.py: how a record becomes text, by the templates of wording/en.json.

import { MOST_DIGITS, writeNumber } from "./numbers.js";

/** @typedef {"radians" | "degrees"} Variant */
/** @typedef {{[name: string]: any}} Fields */

const PLACEHOLDER = / ?\{([\w,]+)(?::(\w+))?\}/g;

/** The value of a field, or the numbers of several. @param {string} names @param {Fields} record */
const pick = (names, record) =>
  names.includes(",") ? names.split(",").flatMap((name) => record[name]) : record[names];

export class Writer {
  /** @param {{[key: string]: string}} templates */
  constructor(templates) {
    this.templates = templates;
  }

  /**
   * @param {string} name of the template, without the kind of the record
   * @param {Fields} record
   * @param {Variant} variant
   * @returns {string}
   */
  write(name, record, variant = "radians") {
    return this.fill(record.kind ? `${name}.${record.kind}` : name, record, variant);
  }

  /** @param {string} key @param {Variant} variant */
  find(key, variant) {
    return this.templates[`${key}@${variant}`] ?? this.templates[key];
  }

  /** @param {string} key @param {Fields} record @param {Variant} variant @returns {string} */
  fill(key, record, variant) {
    return this.find(key, variant).replace(PLACEHOLDER, (whole, name, form) => {
      const text = this.writeValue(name, pick(name, record), form ?? "", record, variant);
      return text && whole.startsWith(" ") ? ` ${text}` : text;
    });
  }

  /**
   * @param {string} name
   * @param {any} value
   * @param {string} form
   * @param {Fields} record
   * @param {Variant} variant
   * @returns {string}
   */
  writeValue(name, value, form, record, variant) {
    if (value === null || value === undefined) return "";
    if (typeof value === "boolean") return this.fill(`${form}.${value}`, record, variant);
    if (typeof value === "number") return writeNumber(value, form);
    if (typeof value === "string")
      return form ? this.fill(`${form}.${value}`, record, variant) : value;
    if (Array.isArray(value)) return this.writeSeveral(name, value, form, record, variant);
    return this.write(form || name, value, variant);
  }

  /**
   * @param {string} name
   * @param {any[]} values
   * @param {string} form
   * @param {Fields} record
   * @param {Variant} variant
   */
  writeSeveral(name, values, form, record, variant) {
    if (form in this.templates && values.every((each) => typeof each === "number")) {
      return this.fillNumbers(form, values, variant);
    }
    const texts = values.map((each) => this.writeValue(name, each, form, record, variant));
    return texts.join(this.templates[`${form}.join`] ?? this.templates.join);
  }

  /** @param {string} key @param {number[]} values @param {Variant} variant */
  fillNumbers(key, values, variant) {
    const template = this.find(key, variant);
    const places = [...template.matchAll(PLACEHOLDER)];
    const write = (/** @type {number} */ more) =>
      places.map(([, place, form]) => writeNumber(values[Number(place)], form, more));
    const tries = Array.from({ length: MOST_DIGITS }, (_, more) => write(more));
    const count = (/** @type {string[]} */ texts) => new Set(texts).size;
    // The shortest of those that tell most numbers apart.
    const texts = tries.reduce((best, each) => (count(each) > count(best) ? each : best));
    if (count(texts) === 1 && `${key}.same` in this.templates)
      return this.fill(`${key}.same`, { ...values }, variant);
    return template.replace(PLACEHOLDER, (whole) => whole.split("{")[0] + texts.shift());
  }
}
