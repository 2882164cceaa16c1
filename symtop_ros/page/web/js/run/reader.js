// Twin of the reader in run/simulation/run_file.py: both follow the fields of run_fields.json. A run is
// understood as a whole before anything of it is used; what is not known of it is dropped.

import { NAMES } from "../physics/records.js";
import { writeNumber } from "../words/numbers.js";

/** @import { Points } from "./marks.js" */
/** @import { EventRecord } from "./run.js" */
/**
 * A field: one of some words, a text of some length, true or false (`flag`), some numbers of limited
 * size, a record of one of some kinds, or a number.
 * Without `absent` a field must be given. A kind of kick (`kick`, its name in the kernel) holds a
 * quantity, nothing (null), or the one that is `chosen`.
 * @typedef {{words?: string[], length?: number, flag?: boolean,
 *   records?: {[kind: string]: {[name: string]: Field}}, size?: number, limit?: number, unit?: string,
 *   low?: number, high?: number, absent?: any, kick?: string, holds?: any}} Field
 */
/** A kind of measured points. @typedef {{columns: string[], residuals?: string[], units: string[]}} Seen */
/**
 * What run_fields.json holds: the fields of an event, of the act of a kick, of measured points, and of the
 * run.
 * @typedef {{formats: number[], most: number, end: Field, event: {[name: string]: Field},
 *   act: {[name: string]: Field}, points: {most: number, limit: number, rows: Field, time: Field,
 *   kinds: {[kind: string]: Seen}, camera: {[name: string]: Field}}}} Table
 */

const PUSHES = ["axle_impulse", "rate", "number"]; // fields of a push
const SHOWN = 60; // characters of a value
const NUMBER = /^[-+]?\d+[eE][-+]?\d+$/; // as Python reads it

/** @param {string} name @param {string} condition @param {any} value */
const reject = (name, condition, value) => {
  const text = JSON.stringify(value) ?? "nothing";
  const shown = text.length > SHOWN ? `${text.slice(0, SHOWN - 3)}...` : text;
  return new RangeError(`${name} must ${condition}, got ${shown}`);
};

/** @param {any} value */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** @param {any} value @param {number} low @param {number} high */
const toNumber = (value, low, high) => {
  const number = typeof value === "string" && NUMBER.test(value) ? Number(value) : value;
  return Number.isFinite(number) && number >= low && number <= high ? number : NaN;
};

/** @param {string} name @param {Field} field @param {any} value */
const readNumber = (name, { unit = "", low = -Infinity, high = Infinity }, value) => {
  const number = toNumber(value, low, high);
  if (!Number.isNaN(number)) return number;
  const range = `${writeNumber(low, "6g")} to ${writeNumber(high, "6g")} ${unit}`.trimEnd();
  const plain = unit ? `a finite number (${unit})` : "a finite number";
  throw reject(name, `be ${Number.isFinite(low) ? range : plain}`, value);
};

/** @param {string} name @param {Field} field @param {any} value */
const readVector = (name, { size = 0, limit = 0, unit }, value) => {
  if (!Array.isArray(value)) throw reject(name, `have ${size} elements (${unit})`, value);
  if (value.length !== size) throw reject(name, `have ${size} elements (${unit})`, value.length);
  const numbers = value.map((each) => toNumber(each, -limit, limit));
  if (!numbers.some(Number.isNaN)) return numbers;
  const range = [-limit, limit].map((each) => writeNumber(each, "6g")).join(" to ");
  throw reject(name, `be ${size} numbers from ${range} (${unit})`, value);
};

/**
 * @param {string} name @param {{[kind: string]: {[name: string]: Field}}} kinds @param {any} value
 * @returns {{[name: string]: any}}
 */
const readRecord = (name, kinds, value) => {
  const kind = isObject(value) ? value.kind : undefined;
  if (typeof kind !== "string" || !Object.hasOwn(kinds, kind))
    throw reject(name, `be a record of kind ${Object.keys(kinds).join(", ")}`, value);
  const fields = Object.entries(kinds[kind]).map(([each, field]) => {
    return [each, readField(each, field, Object.hasOwn(value, each) ? value[each] : undefined)];
  });
  return { kind, ...Object.fromEntries(fields) };
};

/** @param {string} name @param {Field} field @param {any} value @returns {any} */
export const readField = (name, field, value) => {
  const { words, length, records, size, flag } = field;
  if (value === undefined && "absent" in field) return field.absent;
  if (size !== undefined) return readVector(name, field, value);
  if (records) return readRecord(name, records, value);
  if (flag) {
    if (typeof value === "boolean") return value;
    throw reject(name, "be true or false", value);
  }
  if (words) {
    if (words.includes(value)) return value;
    throw reject(name, `be ${words.map((each) => `"${each}"`).join(" or ")}`, value);
  }
  if (length === undefined) return readNumber(name, field, value);
  if (typeof value === "string" && value.length <= length) return value;
  throw reject(name, `be a text of at most ${length} characters`, value);
};

/** @param {{[name: string]: Field}} fields @param {any} given @returns {{[name: string]: any}} */
const readAct = (fields, given) => {
  if (!isObject(given)) throw reject("act", "be the fields of a kick", given);
  const names = Object.keys(fields);
  const read = Object.entries(given).map(([name, value]) => {
    if (!names.includes(name)) throw reject("field name", `be one of ${names.join(", ")}`, name);
    return [name, readField(name, fields[name], value)];
  });
  return Object.fromEntries(read);
};

/** @param {{[name: string]: Field}} fields @param {any} values */
const readPushes = (fields, { act: given }) => {
  const act = readAct(fields, given);
  const names = Object.keys(act);
  if (names.length !== PUSHES.length || !PUSHES.every((name) => name in act))
    throw reject("pushes", `have ${PUSHES.join(", ")}`, names);
  if (Number.isInteger(act.number)) return act;
  throw reject("number", `be a whole number up to ${fields.number.high}`, act.number);
};

/** @param {Table} table @param {any} given @param {EventRecord | null} before @returns {EventRecord} */
const readEvent = (table, given, before) => {
  const values = isObject(given) ? given : {};
  const read = /** @type {any} */ (
    Object.fromEntries(
      Object.entries(table.event).map(([name, field]) => [
        name,
        readField(name, field, Object.hasOwn(values, name) ? values[name] : undefined),
      ]),
    )
  );
  if (!before && read.kind !== "start")
    throw reject("kind", 'be "start" for the first event', read.kind);
  if (before && read.time < before.time)
    throw reject("time", "be at least that of the previous event", read.time);
  const { request, made_by, ...event } = read;
  if (request) event.request = request;
  if (made_by) event.made_by = made_by;
  if (event.kind === "push") return { ...event, act: readPushes(table.act, values) };
  if (event.kind !== "kick") return event;
  const act = readAct(table.act, values.act);
  const [holds] = Object.keys(act).flatMap((name) => {
    const field = table.act[name];
    return "kick" in field ? [field.holds] : [];
  });
  return { ...event, act, hold: holds === "chosen" ? (act.hold ?? NAMES.hold[0]) : holds };
};

/**
 * Rows of numbers, one for each time.
 * @param {string} name @param {any} given @param {number} count @param {string[]} columns @param {number} limit
 */
const readRows = (name, given, count, columns, limit) => {
  if (!Array.isArray(given) || given.length !== count)
    throw reject(`points: ${name}`, `be a list of ${count}, one for each time`, given?.length);
  const field = { size: columns.length, limit, unit: columns.join(", ") };
  return given.map((row, k) => readVector(`points: ${name}[${k}]`, field, row));
};

/** @param {Table["points"]} fields @param {any} given @returns {number[]} */
const readTimes = ({ most, time }, given) => {
  const count = Array.isArray(given) ? given.length : 0;
  if (!count || count > most)
    throw reject("points: times", `be a list of 1 to ${most}`, count || given);
  const times = given.map((/** @type {any} */ each, /** @type {number} */ k) =>
    readNumber(`points: times[${k}]`, time, each),
  );
  for (let k = 1; k < count; k += 1)
    if (!(times[k - 1] < times[k]))
      throw reject(`points: times[${k}]`, "be later than the one before it", times[k]);
  return times;
};

/** @param {Table["points"]} fields @param {any} given @returns {Points} */
const readPoints = (fields, given) => {
  if (!isObject(given))
    throw reject("points", "be a record with kind, times, values and residuals", given);
  const { kind } = given;
  const kinds = Object.keys(fields.kinds);
  if (!kinds.includes(kind)) throw reject("points: kind", `be one of ${kinds.join(", ")}`, kind);
  const { columns, residuals = columns } = fields.kinds[kind];
  const times = readTimes(fields, given.times);
  const rows = readNumber("points: rows", fields.rows, given.rows ?? times.length);
  const read = (/** @type {string} */ name, /** @type {string[]} */ names) =>
    readRows(name, given[name], times.length, names, fields.limit);
  const points = { kind, rows, times, values: read("values", columns) };
  const left = { ...points, residuals: read("residuals", residuals) };
  if (kind !== "pixels") return left;
  const camera = Object.entries(fields.camera).map(([name, field]) => {
    return [name, readNumber(`points: camera: ${name}`, field, given.camera?.[name])];
  });
  return { ...left, camera: Object.fromEntries(camera) };
};

/**
 * Do something for an event; a refusal names its place.
 * @template T
 * @param {number} place
 * @param {() => T} work
 */
export const nameEvent = (place, work) => {
  try {
    return work();
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
    throw new RangeError(`events[${place}]: ${error.message}`);
  }
};

/**
 * The events of run.json, its measured points, and the time in s that the run has reached.
 * @param {Table} table @param {any} json
 */
export const readRun = (table, json) => {
  const formats = table.formats.join(" or ");
  if (!isObject(json) || !table.formats.includes(json.format))
    throw reject("a run", `be one of the page (run.json, format ${formats})`, json);
  const given = json.events;
  if (!Array.isArray(given) || !given.length)
    throw reject("events", "be a list with a start at its beginning", given);
  if (given.length > table.most)
    throw reject("events", `be a list of at most ${table.most}`, given.length);
  /** @type {EventRecord[]} */
  const events = [];
  for (const each of given) {
    const place = events.length;
    events.push(nameEvent(place, () => readEvent(table, each, events[place - 1] ?? null)));
  }
  const end = readField("end", { ...table.end, absent: 0 }, json.end);
  const points = json.points === undefined ? null : readPoints(table.points, json.points);
  return { events, points, end: Math.max(end, points?.times.at(-1) ?? 0) };
};
