// Noise that lasts from row to row: a prediction by the rows before, and what is new in each row.
//
// Twin of truth/residuals/whitening.py, whose text has the sources: an autoregression of the order that Hannan
// and Quinn's criterion chooses, or fractional noise, whose power goes with f^(-2 d), if that is likelier.

import { dot } from "./linear.js";

/** Columns of numbers, for all rows. @typedef {Float64Array[]} Columns */
/** Partial autocorrelations of a column at the lags 1, 2, ... @typedef {number[]} Partial */
/**
 * Rows that are no outliers, and those that come a step after the row before.
 * @typedef {{good: boolean[], follows: boolean[], parameters: number}} Rows
 */
/**
 * Noise of columns: the kept rows, how many rows before each predict it, the partial autocorrelations of
 * each column, and the deviation of what is new.
 * @typedef {{kept: number[], before: number[], partial: Partial[], sigma: number[], outliers: number}} Noise
 */

export const ORDERS = 12; // of an autoregression, at most
const PER_ORDER = 20; // rows for each order
const CLEAR = 20; // twice the logarithm of a ratio of likelihoods, for each column
const POWERS = Array.from({ length: 12 }, (_, k) => 0.05 + (0.44 * k) / 11); // d of fractional noise
const [LONGEST, PER_LAG] = [64, 4]; // rows by which it is predicted, at most, and rows for each
const LARGEST = 0.9999; // partial autocorrelation
const TINY = 1e-300;

/** The coefficients of each order and their deviations, by Durbin and Levinson's recursion. @param {Partial} partial */
const findPredictors = (partial) => {
  /** @type {number[][]} */
  const slopes = [[]];
  const variances = [1];
  for (const [k, own] of partial.entries()) {
    const last = slopes[k];
    slopes.push([...last.map((each, lag) => each - own * last[k - 1 - lag]), own]);
    variances.push(variances[k] * (1 - own ** 2));
  }
  const least = variances[partial.length];
  return { slopes, deviations: variances.map((each) => Math.sqrt(each / least)) };
};

/** How many good rows, each a step after the other, come before each row. @param {Rows} rows @param {number} most */
const countBefore = ({ good, follows }, most) => {
  let begin = 0;
  return good.map((_, row) => {
    if (row > 0 && !(good[row - 1] && follows[row])) begin = row;
    return Math.min(row - begin, most);
  });
};

/** What is new in the kept rows, a column each, in deviations. @param {Noise} noise @param {Columns} columns @returns {Columns} */
export const whitenColumns = ({ kept, before, partial, sigma }, columns) =>
  columns.map((each, k) => {
    const { slopes, deviations } = findPredictors(partial[k]);
    return Float64Array.from(kept, (row) => {
      const used = slopes[before[row]];
      let left = each[row];
      for (let lag = 0; lag < used.length; lag += 1) left -= used[lag] * each[row - 1 - lag];
      return left / (sigma[k] * deviations[before[row]]);
    });
  });

/** The noise with given partial autocorrelations. @param {Columns} columns @param {Rows} rows @param {Partial[]} partial @returns {Noise} */
export const measureNoise = (columns, rows, partial) => {
  const kept = rows.good.flatMap((isGood, row) => (isGood ? [row] : []));
  const before = countBefore(rows, partial[0].length);
  const outliers = rows.good.length - kept.length;
  const noise = { kept, before, partial, sigma: columns.map(() => 1), outliers };
  const free = Math.max(kept.length - rows.parameters / columns.length, 1);
  const sigma = whitenColumns(noise, columns).map((each) => Math.sqrt(dot(each, each) / free));
  return { ...noise, sigma };
};

/** The partial autocorrelations of the noise that is most likely. @param {Columns} columns @param {Rows} rows @returns {Partial[]} */
export const findPacf = (columns, rows) => {
  const [count, width] = [rows.good.length, columns.length];
  const most = Math.min(ORDERS, Math.floor(count / PER_ORDER));
  // A fit takes the share p/(n r) of the power of noise away; it is given back to the correlations.
  const share = rows.parameters / (count * width);
  const all = columns.map((each) => findPartials(giveBack(findLags(each, rows, most), share)));
  const cost = 2 * Math.log(Math.log(Math.max(count, 16))) * width;
  const order = chooseOrder(all, count, cost);
  const partial = all.map((each) => each.slice(0, order));
  if (!order || Math.floor(count / PER_LAG) <= ORDERS) return partial;
  const flicker = findFlicker(columns, rows);
  const [own, other] = [partial, flicker].map((each) => {
    const likely = measureLikelihood(columns, measureNoise(columns, rows, each));
    return likely.reduce((sum, one) => sum + one, 0);
  });
  return own - order * cost > other - cost + CLEAR * width ? partial : flicker;
};

/** @param {number[]} lags covariances @param {number} share */
const giveBack = (lags, share) => {
  const total = lags[0] + 2 * lags.slice(1).reduce((sum, each) => sum + each, 0);
  return lags.map((each) => each + share * Math.max(total, lags[0]));
};

/** @param {Partial[]} all @param {number} count rows @param {number} cost of an order */
const chooseOrder = (all, count, cost) => {
  let [lost, best, order] = [0, 0, 0];
  for (let lag = 1; lag <= all[0].length; lag += 1) {
    for (const each of all) lost += count * Math.log(1 - each[lag - 1] ** 2);
    if (lost + lag * cost < best) [best, order] = [lost + lag * cost, lag];
  }
  return order;
};

/** The covariances of good rows at lags without a gap. @param {Float64Array} column @param {Rows} rows @param {number} most */
const findLags = (column, { good, follows }, most) => {
  let broken = 0;
  const gaps = follows.map((each) => {
    broken += Number(!each);
    return broken;
  });
  const products = (/** @type {number} */ lag) =>
    Array.from(column.subarray(lag).keys(), (row) => row + lag)
      .filter((row) => good[row] && good[row - lag] && gaps[row] === gaps[row - lag])
      .map((row) => column[row] * column[row - lag]);
  return Array.from({ length: most + 1 }, (_, lag) => {
    const found = products(lag);
    const sum = found.reduce((all, each) => all + each, 0);
    return lag ? sum / Math.max(found.length + lag, 1) : sum / found.length + TINY;
  });
};

/** @param {number[]} covariances at the lags 0, 1, ... @returns {Partial} */
const findPartials = (covariances) => {
  /** @type {number[]} */
  let last = [];
  /** @type {Partial} */
  const partial = [];
  let left = covariances[0];
  for (let order = 1; order < covariances.length; order += 1) {
    const seen = last.reduce((sum, each, k) => sum + each * covariances[order - 1 - k], 0);
    const own = Math.min(Math.max((covariances[order] - seen) / left, -LARGEST), LARGEST);
    last = [...last.map((each, k) => each - own * last[order - 2 - k]), own];
    partial.push(own);
    left *= 1 - own ** 2;
  }
  return partial;
};

/** The fractional noise d/(k - d) of each column that is most likely. @param {Columns} columns @param {Rows} rows */
const findFlicker = (columns, rows) => {
  const most = Math.min(LONGEST, Math.floor(rows.good.length / PER_LAG));
  const tried = POWERS.map((d) => {
    const partial = Array.from({ length: most }, (_, k) => d / (k + 1 - d));
    const noise = measureNoise(
      columns,
      { ...rows, parameters: 0 },
      columns.map(() => partial),
    );
    return { partial, likely: measureLikelihood(columns, noise) };
  });
  return columns.map(
    (_, k) => tried.reduce((best, each) => (each.likely[k] > best.likely[k] ? each : best)).partial,
  );
};

/** Twice the logarithm of the likelihood of normal noise for each column, but for a constant. @param {Columns} columns @param {Noise} noise */
const measureLikelihood = (columns, noise) =>
  whitenColumns(noise, columns).map((each, k) => {
    const { deviations } = findPredictors(noise.partial[k]);
    const sizes = noise.kept.map((row) => Math.log(noise.sigma[k] * deviations[noise.before[row]]));
    return -dot(each, each) - 2 * sizes.reduce((sum, one) => sum + one, 0);
  });
