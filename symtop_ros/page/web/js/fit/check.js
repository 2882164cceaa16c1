// The test of the model: white residuals, and the same constants in both halves.
//
// Twin of truth/fit/check.py, whose text has the reasons of the limits.

import { dot, findEigen, multiplyPairs } from "./linear.js";
import { isSwinging } from "./lines.js";
import { splitColumns } from "./noise.js";
import { isWhite } from "./statistics.js";

/** @import { Fit } from "./refine.js" */
/** A constant that differs between the halves. @typedef {{name: string, first: number, second: number, deviations: number}} Change */
/** @typedef {"holds" | "unclear" | "fails"} Verdict */

const CHANGED = 5;
const [SMOOTH, SMOOTH_COLUMN] = [4, 12];
const STRETCH = 8;
const WANDERING = 0.1; // part of the run; a longer correlation time is no noise
const PER_PARAMETER = 10; // independent rows, at least
const CONSTANTS = ["Mgl/Ix", "p_psi/Ix"];
const TINY = 1e-300;

/** @param {Fit} fit */
export const checkFit = (fit) => {
  const columns = splitColumns(fit.white, fit.model.record.width);
  const [is_white, is_smooth] = [isWhite(columns), isSmooth(fit)];
  const [changes, stretch, fault] = [listChanges(fit), findStretch(fit), findFault(fit)];
  const swings = isSwinging(fit);
  const isNoise = is_white && !is_smooth && !fault && !stretch;
  /** @type {Verdict} */
  let verdict = isNoise && !fit.isLone ? "holds" : "unclear";
  if (changes.length || swings || (!is_white && is_smooth)) verdict = "fails";
  return { verdict, is_white, is_smooth, swings, changes, stretch, fault };
};

/** Whether residuals change slowly: they may be motion. @param {Fit} fit */
const isSmooth = ({ model, noise, residuals }) => {
  const columns = splitColumns(residuals, model.record.width).map((each, k) =>
    noise.kept.map((row) => each[row] / noise.sigma[k]),
  );
  const squares = columns.map((each) => dot(each, each) / each.length);
  const steps = columns.map((each, k) => {
    const sum = each.slice(1).reduce((all, next, row) => all + (next - each[row]) ** 2, 0);
    const rounding = model.record.rounding[k] / noise.sigma[k];
    return Math.max(sum / (each.length - 1) / 2, rounding ** 2);
  });
  const sum = (/** @type {number[]} */ all) => all.reduce((a, b) => a + b, 0);
  const smoothness = Math.sqrt(sum(squares) / Math.max(sum(steps), TINY));
  const most = Math.max(...squares.map((each, k) => Math.sqrt(each / Math.max(steps[k], TINY))));
  return smoothness > SMOOTH || most > SMOOTH_COLUMN;
};

/** Most outliers that follow each other; 0 if they are too few to mean anything. @param {Fit} fit */
const findStretch = ({ model, noise }) => {
  const ends = [-1, ...noise.kept, model.record.count];
  const longest = Math.max(...ends.slice(1).map((each, k) => each - ends[k])) - 1;
  return longest >= STRETCH ? longest : 0;
};

/** Why there are no honest deviations. @param {Fit} fit */
const findFault = ({ independent, model, noise }) => {
  const count = noise.kept.length;
  const lasts = ((count / independent - 1) / 2) * (model.record.seconds / Math.max(count - 1, 1));
  if (lasts > WANDERING * model.record.seconds) return "wanders";
  return independent < PER_PARAMETER ? "few" : "";
};

/** @param {Fit} fit @returns {Change[]} */
const listChanges = (fit) => {
  const [first, second] = [false, true].map((late) => findHalf(fit, late));
  const changes = CONSTANTS.map((name) => {
    const place = fit.model.place[name];
    const both = Math.hypot(first.deviations[place], second.deviations[place]);
    const [a, b] = [first.x[place], second.x[place]];
    return { name, first: a, second: b, deviations: Math.abs(a - b) / Math.max(both, TINY) };
  });
  return changes.filter(({ deviations }) => deviations > CHANGED);
};

/** The parameters of one half, by one step of Gauss and Newton. @param {Fit} fit @param {boolean} late */
const findHalf = (fit, late) => {
  const { columns, priors, sizes } = fit.slopes;
  const width = fit.model.record.width;
  const middle = Math.floor(fit.white.length / width / 2) * width;
  const cut = (/** @type {Float64Array} */ rows) =>
    late ? rows.slice(middle) : rows.slice(0, middle);
  const scaled = columns.map((each, k) => cut(each).map((slope) => slope / sizes[k]));
  const normal = multiplyPairs(scaled);
  normal.forEach((row, k) => {
    row[k] += priors[k] / sizes[k] ** 2;
  });
  const { values, vectors } = findEigen(normal);
  const raised = values.map((each) => Math.max(each, 1e-12 * values[values.length - 1]));
  const invert = (/** @type {number} */ j, /** @type {number} */ k) =>
    vectors.reduce((sum, each, n) => sum + (each[j] * each[k]) / raised[n], 0);
  const scores = scaled.map((each) => dot(each, cut(fit.white)));
  // noise that is not white after all makes sums larger than those of independent numbers
  const wider = Math.sqrt(fit.noise.kept.length / Math.max(fit.independent, 1));
  return {
    x: fit.x.map(
      (each, k) => each - scores.reduce((sum, one, j) => sum + invert(j, k) * one, 0) / sizes[k],
    ),
    deviations: sizes.map((size, k) => (wider * Math.sqrt(invert(k, k))) / size),
  };
};
