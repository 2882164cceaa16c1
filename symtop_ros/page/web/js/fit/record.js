// A record: points of the axis at some times. Twin of truth/fit/record.py, for two kinds.

import { transpose } from "./linear.js";
import { findMedian, findQuantile, findSpread } from "./statistics.js";

/**
 * What is fitted: x, y, z of the axis or u, v of a picture (v upwards), and what is known besides, each
 * with a standard deviation. With perspective the distance of the camera is looked for, which looks at the
 * centre of the picture; if that is not known, at the pivot.
 * @typedef {{kind: "axis" | "pixels", times: number[], values: number[][],
 *   known?: {[name: string]: [number, number]}, perspective?: boolean, centre?: readonly [number, number]}} Given
 */

export const FEWEST = 12; // rows
export const MOST = 2000; // rows; of more the first are taken
const GAP = 1.5; // medians of the steps; a longer step ends a run of noise
const STILL = 1e-9; // of the size of the numbers; what changes less does not move
const [LENGTH, USUAL] = [0.1, 0.75]; // relative differences of lengths, in most rows
const [USUAL_SPIKE, SPIKE] = [0.9, 4]; // part of the differences from medians, and times beyond it
const MULTIPLES = 6; // the smallest difference of rounded values is a step, or 2 or 3, and seldom more
const MANY = 1e12;
const EVEN = 0.1;
const FIXED = 12; // deviations of rounding, of which a step has 3.5
const WIDTHS = { axis: 3, pixels: 2 };

export class Record {
  /**
   * @param {Given} given as it was taken @param {Float64Array} times from zero, in s
   * @param {number[][]} values @param {boolean} hasLength the distance of the point is looked for
   */
  constructor(given, times, values, hasLength) {
    this.given = given;
    this.kind = given.kind;
    this.known = given.known ?? {};
    this.hasPerspective = given.kind === "pixels" && Boolean(given.perspective);
    this.times = times;
    this.values = values;
    this.flat = Float64Array.from(values.flat());
    this.hasLength = hasLength;
    this.width = WIDTHS[given.kind];
  }

  get count() {
    return this.times.length;
  }

  get step() {
    return findMedian(this.times.slice(1).map((each, k) => each - this.times[k]));
  }

  get seconds() {
    return this.times[this.count - 1];
  }

  /** For each row whether it comes a step after the row before. */
  get follows() {
    const most = GAP * this.step;
    return Array.from(this.times, (each, k) => k > 0 && each - this.times[k - 1] < most);
  }

  /** The same record without perspective. */
  get plain() {
    const given = { ...this.given, perspective: false };
    return new Record(given, this.times, this.values, this.hasLength);
  }

  /** The first rows. @param {number} count */
  cut(count) {
    const [times, values] = [this.times.slice(0, count), this.values.slice(0, count)];
    return new Record(this.given, times, values, this.hasLength);
  }

  /** The deviation of the values of each column. */
  get spreads() {
    return transpose(this.values).map(findSpread);
  }

  /** The deviation of the rounding of each column; 0 if none is seen. */
  get rounding() {
    return transpose(this.values).map((each) => findStep(each) / Math.sqrt(12));
  }

  /** Whether a column stays within a few steps of rounding: all its rows have one error. */
  get fixed() {
    const { rounding } = this;
    return transpose(this.values).map((each, k) => {
      const [least, most] = [Math.min, Math.max].map((of) => each.reduce((a, b) => of(a, b)));
      return most - least < FIXED * rounding[k];
    });
  }

  /** With medians of their neighbours in place of single wrong rows. */
  get smooth() {
    const columns = transpose(this.values).map(findFar);
    const values = this.values.map((row, k) =>
      columns.some(({ isWrong }) => isWrong[k]) ? columns.map(({ middle }) => middle[k]) : row,
    );
    return new Record(this.given, this.times, values, this.hasLength);
  }
}

/** @param {number[]} column */
const findFar = (column) => {
  const clip = (/** @type {number} */ k) => column[Math.min(Math.max(k, 0), column.length - 1)];
  const middle = column.map((_, k) => findMedian([-2, -1, 0, 1, 2].map((by) => clip(k + by))));
  const far = column.map((each, k) => Math.abs(each - middle[k]));
  const most = SPIKE * findQuantile(far, USUAL_SPIKE) + 1e-300;
  return { middle, isWrong: far.map((each) => each > most) };
};

/** The step of which all values are multiples, apart from a constant; 0: of none. @param {number[]} values */
const findStep = (values) => {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  const differences = sorted.slice(1).map((each, k) => each - sorted[k]);
  if (!differences.length) return 0;
  const unit = differences.reduce((a, b) => Math.min(a, b)) / MULTIPLES;
  const counts = differences.map((each) => each / unit);
  const isEven = counts.every((each) => each <= MANY && Math.abs(each - Math.round(each)) <= EVEN);
  return isEven ? counts.map(Math.round).reduce(divideBoth) * unit : 0;
};

/** The greatest common divisor. @param {number} a @param {number} b @returns {number} */
const divideBoth = (a, b) => (b ? divideBoth(b, a % b) : a);

/** The record of what was given; a RangeError says what is odd about it. @param {Given} given */
export const makeRecord = (given) => {
  refuseOdd(given);
  const [times, rows] = [given.times.slice(0, MOST), given.values.slice(0, MOST)];
  const { values, length } = given.kind === "axis" ? normalize(rows) : { values: rows, length: 1 };
  refuseStill(values);
  const passed = Float64Array.from(times, (each) => each - times[0]);
  return new Record(given, passed, values, length !== 1);
};

/** @param {Given} given */
const refuseOdd = ({ times, values }) => {
  if (times.length < FEWEST)
    throw new RangeError(`a record must have at least ${FEWEST} rows, got ${times.length}`);
  const odd = times.findIndex((t, k) => ![t, ...values[k]].every(Number.isFinite));
  if (odd >= 0)
    throw new RangeError(`a record must have finite numbers, got ${values[odd]} in row ${odd + 1}`);
  const back = times.findIndex((t, k) => k > 0 && t <= times[k - 1]);
  if (back > 0)
    throw new RangeError(
      `times must grow, got ${times[back]} s after ${times[back - 1]} s in row ${back + 1}`,
    );
};

/** @param {number[][]} values */
const refuseStill = (values) => {
  const columns = transpose(values);
  const most = (/** @type {number[]} */ each) => each.reduce((a, b) => Math.max(a, b));
  const moved = columns.map((each) => most(each) + most(each.map((one) => -one)));
  const size = most(columns.map((each) => most(each.map(Math.abs))));
  if (most(moved) <= STILL * Math.max(size, 1e-300))
    throw new RangeError(
      `a record must show a motion, got points that do not change: ${values[0]}`,
    );
};

/** Rows of norm 1; those of points at one distance are divided by it together. @param {number[][]} rows */
const normalize = (rows) => {
  const norms = rows.map((row) => Math.hypot(...row));
  const none = norms.indexOf(0);
  if (none >= 0)
    throw new RangeError(`axis in row ${none + 1} must be a vector other than zero, got 0`);
  const usual = findMedian(norms);
  const divide = (/** @type {(k: number) => number} */ by) =>
    rows.map((row, k) => row.map((each) => each / by(k)));
  if (
    findQuantile(
      norms.map((each) => Math.abs(each / usual - 1)),
      USUAL,
    ) >= LENGTH
  )
    return { values: divide((k) => norms[k]), length: 1 };
  const steps = transpose(rows).map(findStep);
  const errors = Math.max(findSpread(norms), ...steps, STILL);
  const length = Math.abs(usual - 1) <= errors ? 1 : usual;
  return { values: divide(() => length), length };
};
