// The noise of what a motion leaves: outliers, and a deviation of each column. It is taken as white.

import { findSpread } from "./statistics.js";

/** @import { Model } from "./model.js" */
/** @typedef {ReturnType<typeof findNoise>} Noise */

const OUTLIER = 5; // deviations; a normal number is farther once in two million
const DOUBLE = 1e-14; // of the values; what exact states leave is rounding, and no smaller

/** Numbers of rows, by column. @param {Float64Array} flat @param {number} width */
export const splitColumns = (flat, width) =>
  Array.from({ length: width }, (_, k) => flat.filter((_, place) => place % width === k));

/** @param {Model} model @param {number[]} x */
export const findNoise = (model, x) => {
  const { record } = model;
  const columns = splitColumns(model.findResiduals(x), record.width);
  const size = record.flat.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
  const least = record.rounding.map((each) => Math.max(each, DOUBLE * size));
  const floors = columns.map((each, k) => Math.max(findSpread(each), least[k]));
  let kept = Array.from(columns[0].keys()).flatMap((row) =>
    columns.every((each, k) => Math.abs(each[row]) < OUTLIER * floors[k]) ? [row] : [],
  );
  if (!kept.length) kept = Array.from(columns[0], (_, row) => row);
  const free = Math.max(kept.length - x.length / record.width, 1);
  const sigma = columns.map((each, k) => {
    const squares = kept.reduce((sum, row) => sum + each[row] ** 2, 0);
    return Math.max(Math.sqrt(squares / free), least[k]);
  });
  return { kept, sigma, outliers: columns[0].length - kept.length };
};

/** The kept rows of some, in deviations. @param {Noise} noise @param {Float64Array} rows */
export const whiten = ({ kept, sigma }, rows) => {
  const width = sigma.length;
  const found = new Float64Array(kept.length * width);
  kept.forEach((row, place) => {
    for (let k = 0; k < width; k += 1) found[place * width + k] = rows[row * width + k] / sigma[k];
  });
  return found;
};
