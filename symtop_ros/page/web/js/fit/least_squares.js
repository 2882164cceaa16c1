// Least squares by steps of Levenberg and Marquardt, with a loss in which outliers count less.

import { dot, multiplyPairs, solve } from "./linear.js";

const [DAMPING, LESS, MORE] = [1e-3, 1 / 5, 4]; // at the start, and after a good and a bad step
const [CALM, LOST] = [0.1, 1e12]; // damping of a step that may end the way, and of one without hope
const RIDGE = 1e-12; // of the largest square of a column
const TINY = 1e-300;

/**
 * A problem: residuals of parameters, a column of derivatives for each, what a parameter may be at
 * least and at most, and whether the loss is that of soft_l1, 2 (sqrt(1 + f^2) - 1), or f^2.
 * @typedef {{find: (x: number[]) => Float64Array, derive: (x: number[]) => Float64Array[],
 *   clip: (x: number[]) => number[], isSoft: boolean}} Problem
 */

/** @param {Float64Array} left @param {boolean} isSoft */
const measure = (left, isSoft) => {
  if (!isSoft) return dot(left, left) / 2;
  return left.reduce((sum, f) => sum + Math.sqrt(1 + f * f) - 1, 0);
};

/**
 * Residuals and derivatives whose squares have the slope and the curvature of the loss (Triggs et al.,
 * Bundle Adjustment, 1999).
 * @param {Float64Array} left @param {Float64Array[]} columns
 */
const soften = (left, columns) => {
  const size = left.map((f) => (1 + f * f) ** -0.75);
  return {
    left: left.map((f, k) => f * size[k] ** (-1 / 3)),
    columns: columns.map((each) => each.map((slope, k) => slope * size[k])),
  };
};

/**
 * Parameters, what they leave, and its cost.
 * @typedef {{x: number[], left: Float64Array, cost: number}} Point
 */

/** @param {Problem} problem @param {number[]} x @returns {Point} */
const evaluate = ({ find, isSoft }, x) => {
  const left = find(x);
  return { x, left, cost: measure(left, isSoft) };
};

/**
 * The parameters that leave least, near some, and the cost of what they leave. It ends if a step makes
 * the cost smaller by less than a part `precise`, or after `most` steps.
 * @param {Problem} problem @param {number[]} start @param {number} most @param {number} precise
 */
export const minimise = (problem, start, most, precise) => {
  let best = evaluate(problem, problem.clip(start));
  let damping = DAMPING;
  for (let step = 0; step < most; step += 1) {
    const { normal, slopes } = write(problem, best);
    if (!slopes.every(Number.isFinite)) return { x: best.x, cost: Infinity };
    const found = descend(problem, best, normal, slopes, damping);
    if (!found) break;
    const isLast = best.cost - found.point.cost < precise * best.cost && found.damping <= CALM;
    best = found.point;
    damping = found.damping * LESS;
    if (isLast) break;
  }
  return { x: best.x, cost: best.cost };
};

/**
 * A better point, and the damping that led there; null if there is none.
 * @param {Problem} problem @param {Point} best @param {number[][]} normal @param {number[]} slopes
 * @param {number} first
 */
const descend = (problem, best, normal, slopes, first) => {
  for (let damping = first; damping < LOST; damping *= MORE) {
    const x = move(best.x, normal, slopes, damping);
    const point = x && evaluate(problem, problem.clip(x));
    if (point && point.cost < best.cost) return { point, damping };
  }
  return null;
};

/** The products of derivatives with each other, and with what is left. @param {Problem} problem @param {Point} best */
const write = ({ derive, isSoft }, best) => {
  const seen = { left: best.left, columns: derive(best.x) };
  const { left, columns } = isSoft ? soften(seen.left, seen.columns) : seen;
  return { normal: multiplyPairs(columns), slopes: columns.map((each) => dot(each, left)) };
};

/** @param {number[]} x @param {number[][]} normal @param {number[]} slopes @param {number} damping */
const move = (x, normal, slopes, damping) => {
  const sizes = normal.map((row, k) => Math.sqrt(row[k]) + TINY);
  const scaled = normal.map((row, j) =>
    row.map((each, k) => each / sizes[j] / sizes[k] + (j === k ? damping + RIDGE : 0)),
  );
  const step = solve(scaled, [slopes.map((each, k) => each / sizes[k])])?.[0];
  return step && x.map((each, k) => each - step[k] / sizes[k]);
};
