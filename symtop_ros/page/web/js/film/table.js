// Points of the axis, or of a picture, from a table of text: twin of truth/fit/files.py for two kinds.

import { phrase } from "../words/wording.js";

const LARGEST = 50 << 20; // bytes
const HEAD = 10; // lines within which the names of columns are looked for
const SHOWN = 60; // characters of a line in a message
/** @type {{[unit: string]: number}} */
const SECONDS = { s: 1, ms: 1e-3, us: 1e-6, ns: 1e-9 };
const NANO = 1e-9;
// As in truth/tables/columns.py.
const TIMES =
  /^(?:__)?(?:t|time|times|timestamp|time_?stamp|stamp|sec|secs|seconds)(?:_?(ns|us|ms|s))?$/;
const AXIS = /^(?:(?:.*[._/ ])?(?:axis|e)[._/ ]?|)([xyz])$/;
const POINT = /^(?:pixel|px|point)?[._/ ]?([uvxy])$/;
const UNIT = /\s*[[(]\s*([^\])]*?)\s*[\])]\s*$/;
const QUATERNION =
  /^(?:(?:.*[._/ ])?(?:q|quat|quaternion|orientation|rotation|attitude)(?:_\w+?)?[._/ ]?|)[wxyz]$/;
/** Columns that top_fit takes, and the page does not. */
const OTHERS = [
  /^(.*[._/ ])?(q|quat|quaternion|orientation|rotation|attitude)?[._/ ]?(w|q_?0)$/,
  /^(measured_)?[fw]_?[xyz]$|acceleration|accelerometer|specific_force|angular_velocity|gyr/,
  /^(theta|tilt|nutation)$/,
];
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;
const WHOLE = /^-?\d+$/;

const MISSING = /^(|nan|na|n\/a|null|--?)$/i;

/** @typedef {{kind: "axis" | "pixels", time: number, columns: number[], seconds: number, names: number}} Places seconds: 0 for ns if the numbers are whole; names: how many there are */
/** @typedef {{kind: "axis" | "pixels", times: number[], values: number[][], empty: number}} Table */

/** @param {string} kind @param {{[name: string]: any}} fields */
const refuse = (kind, fields) =>
  new RangeError(
    phrase("measure.table", { kind, ...fields, got: fields.got.trim().slice(0, SHOWN) }),
  );

/** The cells of a line; in quotes a separator is a letter. @param {string} line @param {string | null} separator */
const splitCells = (line, separator) => {
  if (separator === null) return line.trim().split(/\s+/);
  const cells = [""];
  let isQuoted = false;
  for (const [k, letter] of [...line].entries()) {
    const last = cells.length - 1;
    if (letter === '"' && (isQuoted || !cells[last].trim())) {
      /** @type {boolean} */
      const isDouble = isQuoted && line[k + 1] === '"';
      isQuoted = !isQuoted || isDouble;
    } else if (letter === separator && !isQuoted) cells.push("");
    else cells[last] += letter;
  }
  return cells.map((each) => each.trim());
};

/** @param {string} line @param {string[]} separators in the order in which they are looked for */
const findSeparator = (line, separators) => separators.find((each) => line.includes(each)) ?? null;

/** @param {string} line */
const splitNames = (line) => {
  const text = line.trim().replace(/^#+/, "").trim();
  const heads = splitCells(text, findSeparator(text, [",", ";", "\t"]));
  return heads.map((head) => ({
    name: head.replace(UNIT, "").toLowerCase(),
    unit: head.match(UNIT)?.[1].toLowerCase() ?? "",
  }));
};

/** The places of letters in names. @param {string[]} names @param {RegExp} pattern */
const findLetters = (names, pattern) => {
  /** @type {{[letter: string]: number}} */
  const places = {};
  for (const [k, name] of names.entries()) {
    const letter = name.match(pattern)?.[1];
    if (letter) places[letter] = k;
  }
  return places;
};

/** The columns of points, if there are. @param {string[]} names @returns {{kind: "axis" | "pixels", columns: number[]} | null} */
const findPoints = (names) => {
  const [axis, point] = [findLetters(names, AXIS), findLetters(names, POINT)];
  if ("u" in point && "v" in point) return { kind: "pixels", columns: [point.u, point.v] };
  const isAttitude = names.some((name) => name.endsWith("w") && QUATERNION.test(name));
  if (["x", "y", "z"].every((each) => each in axis))
    return isAttitude ? null : { kind: "axis", columns: [axis.x, axis.y, axis.z] };
  const isFlat = "x" in point && "y" in point && !("z" in axis);
  return isFlat ? { kind: "pixels", columns: [point.x, point.y] } : null;
};

/** Seconds of a unit of time; 0 for ns if the numbers are whole. @param {{name: string, unit: string}} head */
const findSeconds = ({ name, unit }) => {
  const said = unit in SECONDS ? unit : name.match(TIMES)?.[1];
  if (said) return SECONDS[said];
  if (name === "stamp") return NANO;
  return name.includes("stamp") ? 0 : 1;
};

/** @param {string} line @param {string} file its name @returns {Places | null} null if these are no names */
const findPlaces = (line, file) => {
  const heads = splitNames(line);
  const names = heads.map(({ name }) => name);
  const times = [...names.keys()].filter((k) => TIMES.test(names[k]));
  if (!times.length) return null;
  const points = findPoints(names);
  if (!points) {
    const isOther = names.some((name) => OTHERS.some((pattern) => pattern.test(name)));
    if (!isOther) return null;
    throw refuse("other", { file, got: "" });
  }
  const time = times.find((k) => names[k].includes("stamp")) ?? times[0];
  for (const place of [time, ...points.columns])
    if (names.filter((name) => name === names[place]).length > 1)
      throw refuse("twice", { file, got: names[place] });
  return { ...points, time, seconds: findSeconds(heads[time]), names: names.length };
};

/** @param {string} cell @param {string | null} separator */
const readNumber = (cell, separator) => {
  const text = separator === "," ? cell : cell.replace(",", ".");
  return NUMBER.test(text) ? Number(text) : NaN;
};

/**
 * The rows below the names, as numbers; a row in which one is missing is left out.
 * @param {{line: string, number: number}[]} lines @param {Places} places @param {string} file
 */
const readRows = (lines, { time, columns, names }, file) => {
  const rows = lines.filter(({ line }) => !line.startsWith("#"));
  const separator = rows.length ? findSeparator(rows[0].line, [";", "\t", ","]) : null;
  let isWhole = true;
  const numbers = rows.flatMap(({ line, number }) => {
    const cells = splitCells(line, separator);
    if (cells.slice(names).some((cell) => cell)) throw refuse("more", { file, number, got: line });
    const picked = [time, ...columns].map((place) => cells[place]);
    if (picked.some((cell) => cell === undefined))
      throw refuse("columns", { file, number, got: line });
    isWhole &&= WHOLE.test(picked[0]);
    if (picked.some((cell) => MISSING.test(cell))) return [];
    const row = picked.map((cell) => readNumber(cell, separator));
    if (!row.every(Number.isFinite)) throw refuse("numbers", { file, number, got: line });
    return [row];
  });
  return { numbers, isWhole, empty: rows.length - numbers.length };
};

/**
 * A table of text as a record.
 * @param {string} text @param {string} file its name @returns {Table}
 */
export const parseTable = (text, file) => {
  const lines = text
    .replace(/^\ufeff/, "")
    .split(/\r\n|\n|\r/)
    .map((line, k) => ({ line, number: k + 1 }))
    .filter(({ line }) => line.trim());
  for (let k = 0; k < Math.min(lines.length, HEAD); k += 1) {
    const places = findPlaces(lines[k].line, file);
    if (!places) continue;
    const { numbers, isWhole, empty } = readRows(lines.slice(k + 1), places, file);
    const seconds = places.seconds || (isWhole ? NANO : 1);
    return {
      kind: places.kind,
      times: numbers.map(([time]) => (time - numbers[0][0]) * seconds),
      values: numbers.map((row) => row.slice(1)),
      empty,
    };
  }
  throw refuse("names", { file, got: lines[0]?.line ?? phrase("nothing") });
};

/** @param {File} file */
export const readTable = async (file) => {
  if (file.size > LARGEST) throw refuse("long", { file: file.name, got: `${file.size}` });
  return parseTable(await file.text(), file.name);
};
