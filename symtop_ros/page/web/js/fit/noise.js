// The noise of what a motion leaves: outliers, what lasts from row to row, and a deviation of each column.
//
// Twin of find_noise in truth/fit/refine.py.

import { findPacf, measureNoise, whitenColumns } from "./whitening.js";
import { findSpread } from "./statistics.js";

/** @import { Model } from "./model.js" */
/** @import { Noise } from "./whitening.js" */

const OUTLIER = 5; // deviations; a normal number is farther once in two million
const DOUBLE = 1e-14; // of the values; what exact states leave is rounding, and no smaller

/** Numbers of rows, by column. @param {Float64Array} flat @param {number} width */
export const splitColumns = (flat, width) =>
  Array.from({ length: width }, (_, k) => flat.filter((_, place) => place % width === k));

/** @param {Model} model @param {number[]} x @param {boolean} lasts whether noise may last @returns {Noise} */
export const findNoise = (model, x, lasts) => {
  const { record } = model;
  const columns = splitColumns(model.findResiduals(x), record.width);
  const size = record.flat.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
  const least = record.rounding.map((each) => Math.max(each, DOUBLE * size));
  const floors = columns.map((each, k) => Math.max(findSpread(each), least[k]));
  let good = Array.from(columns[0], (_, row) =>
    columns.every((each, k) => Math.abs(each[row]) < OUTLIER * floors[k]),
  );
  if (!good.some(Boolean)) good = good.map(() => true);
  const rows = { good, follows: record.follows, parameters: x.length };
  const { fixed } = record;
  const partial = (lasts ? findPacf(columns, rows) : columns.map(() => [])).map((each, k) =>
    fixed[k] ? each.map(() => 0) : each,
  );
  const noise = measureNoise(columns, rows, partial);
  const count = noise.kept.length; // rows that have one error count as one
  const sigma = noise.sigma.map(
    (each, k) => Math.max(each, least[k]) * (fixed[k] ? Math.sqrt(count) : 1),
  );
  return { ...noise, sigma };
};

/** What is new in the kept rows of some, in deviations. @param {Noise} noise @param {Float64Array} flat */
export const whiten = (noise, flat) => {
  const width = noise.sigma.length;
  const columns = whitenColumns(noise, splitColumns(flat, width));
  const found = new Float64Array(noise.kept.length * width);
  columns.forEach((each, k) => {
    for (let row = 0; row < each.length; row += 1) found[row * width + k] = each[row];
  });
  return found;
};
