// Numbers with noise: medians, correlations, and the variance of sums that are correlated.
//
// Twin of truth/residuals/residuals.py, whose text has the sources.

import { dot } from "./linear.js";

/** @typedef {ArrayLike<number>} Numbers */

const NORMAL = 1.4826; // deviation of a normal distribution, in median distances from the median
const TINY = 1e-300;
const LAGS = 10;
const BLOCKS = [1, 8, 64]; // rows in a mean
const FEWEST = 50; // means that a test needs
const WHITE = 40; // ten squares of normal numbers add up to more once in 50 000 times
const QUIET = 50; // a fiftieth of all lags without a correlation: there are no more

/** @param {Numbers} numbers @param {number} part 0 to 1, between two numbers by a straight line */
export const findQuantile = (numbers, part) => {
  const sorted = Float64Array.from(numbers).sort();
  const place = part * (sorted.length - 1);
  const low = Math.floor(place);
  const high = Math.min(low + 1, sorted.length - 1);
  return sorted[low] + (place - low) * (sorted[high] - sorted[low]);
};

/** @param {Numbers} numbers */
export const findMedian = (numbers) => findQuantile(numbers, 0.5);

/** A deviation on which outliers have no influence. @param {Numbers} numbers */
export const findSpread = (numbers) => {
  const middle = findMedian(numbers);
  return NORMAL * findMedian(Array.from(numbers, (each) => Math.abs(each - middle))) + TINY;
};

/** The autocovariances at all lags, summed over columns. @param {Numbers[]} columns */
const findCovariances = (columns) => {
  const count = columns[0].length;
  const found = new Float64Array(count);
  for (const each of columns)
    for (let lag = 0; lag < count; lag += 1) {
      let sum = 0;
      for (let k = lag; k < count; k += 1) sum += each[k] * each[k - lag];
      found[lag] += sum / count;
    }
  return found;
};

/** Number of rows that are independent: all, if the noise is white. @param {Numbers[]} columns */
export const countIndependent = (columns) => {
  const [count, covariances] = [columns[0].length, findCovariances(columns)];
  let sum = 0;
  for (let lag = 1; covariances[0] && lag < count; lag += 1)
    sum += (covariances[lag] / covariances[0]) ** 2 - (1 - lag / count) / count;
  return count / (1 + 4 * Math.max(sum, 0));
};

/** Whether no correlation of rows is significant. @param {Numbers[]} columns */
export const isWhite = (columns) =>
  BLOCKS.every((block) => {
    if (block > 1 && columns[0].length < FEWEST * block) return true;
    return measureCorrelation(columns.map((each) => average(each, block))) <= WHITE;
  });

/** @param {Numbers} numbers @param {number} block */
const average = (numbers, block) =>
  Array.from({ length: Math.floor(numbers.length / block) }, (_, k) => {
    const part = Array.prototype.slice.call(numbers, k * block, (k + 1) * block);
    return part.reduce((sum, each) => sum + each, 0) / block;
  });

/** The squares of the correlations at the first lags, in deviations. @param {number[][]} columns */
const measureCorrelation = (columns) => {
  const count = columns[0].length;
  let found = 0;
  for (let lag = 1; lag <= Math.min(LAGS, Math.floor(count / 4)); lag += 1) {
    let [sum, squares] = [0, 0];
    for (let k = lag; k < count; k += 1) {
      let product = 0;
      for (const each of columns) product += each[k] * each[k - lag];
      sum += product;
      squares += product * product;
    }
    found += sum ** 2 / Math.max(squares, TINY);
  }
  return found;
};

/**
 * The variance of the sum of correlated numbers, of which so many are free.
 * @param {Numbers} values @param {number} parameters @param {number} independent
 */
export const sumInfluences = (values, parameters, independent) => {
  const square = dot(values, values);
  if (!square) return 0;
  const variance = Math.max(filterAndSum(values, parameters), values.length * sumLags(values));
  const free = Math.min(independent, (values.length * square) / variance);
  const exceed = (/** @type {number} */ count) => free / Math.max(free - count, 1);
  return variance * exceed(parameters) * exceed(4);
};

/** By an autoregression of first order, and what it leaves. @param {Numbers} values @param {number} parameters */
const filterAndSum = (values, parameters) => {
  const [count, all] = [values.length, Array.from(values)];
  let slope = dot(all.slice(1), all) / dot(all, all);
  if (slope > 0) slope += (2 * slope + parameters * (1 + slope)) / count;
  slope = Math.min(slope, 1 - 1 / count);
  const left = all.slice(1).map((each, k) => each - slope * all[k]);
  return (count * sumLags(left)) / (1 - slope) ** 2;
};

/** The sum of autocovariances over all lags. @param {Numbers} values */
const sumLags = (values) => {
  const covariances = findCovariances([values]);
  const { flat, moment } = sumFlat(covariances);
  const ratio = flat > 0 ? moment / flat : 0;
  const width = Math.min(1.1447 * Math.cbrt(ratio ** 2 * values.length), values.length / 4);
  let bartlett = covariances[0];
  for (let lag = 1; lag <= Math.floor(width); lag += 1)
    bartlett += 2 * (1 - lag / (width + 1)) * covariances[lag];
  return Math.max(bartlett, flat);
};

/** By a flat kernel; also of their products with the lag. @param {Float64Array} covariances */
const sumFlat = (covariances) => {
  const most = Math.min(2 * Math.max(findLast(covariances), 1), Math.floor(covariances.length / 2));
  let [flat, moment] = [covariances[0], 0];
  for (let lag = 1; lag <= most; lag += 1) {
    const kept = 2 * Math.min(Math.max(2 * (1 - lag / most), 0), 1) * covariances[lag];
    flat += kept;
    moment += lag * kept;
  }
  return { flat, moment };
};

/** The lag after which correlations are chance. @param {Float64Array} covariances */
const findLast = (covariances) => {
  const count = covariances.length;
  const chance = 2 * Math.sqrt(Math.log10(Math.max(count, 2)) / count) * covariances[0];
  const run = Math.max(5, Math.floor(count / QUIET));
  let calm = 0;
  for (let lag = 1; lag < count; lag += 1) {
    calm = Math.abs(covariances[lag]) < chance ? calm + 1 : 0;
    if (calm === run) return lag - run;
  }
  return Math.floor(count / 4);
};
