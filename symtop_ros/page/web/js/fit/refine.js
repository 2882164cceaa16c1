// A motion that was fitted, by the noise that it leaves, and the deviations of its numbers.
//
// Twin of truth/fit/refine.py.

import { apply, dot, findEigen, multiplyPairs, transpose } from "./linear.js";
import { findNoise, splitColumns, whiten } from "./noise.js";
import { findShifts, sumShifts } from "./rounding.js";
import { fitWeighted } from "./search.js";
import { countIndependent, sumInfluences } from "./statistics.js";

/** @import { Model } from "./model.js" */
/** @import { Noise } from "./whitening.js" */
/**
 * Derivatives of the rows in deviations, a column for each parameter; weights of what is known; and
 * Fisher's matrix of parameters times sizes, by its eigenvalues and vectors.
 * @typedef {{columns: Float64Array[], priors: number[], sizes: number[], values: number[],
 *   vectors: number[][]}} Slopes
 */

const ROUNDS = 8; // of weights and least squares
const SETTLED = 1e-3; // of the deviations and correlations of noise
const PRECISE = 1e-7; // of the sum of squares: a hundredth of a deviation of a parameter
const STEPS = 60;
const LONG = 1e4; // rad, of the fastest phase in a record
const NULL = 1e-16; // of the largest eigenvalue, to which a smaller one is raised
const TINY = 1e-300;

export class Fit {
  /** @param {Model} model @param {number[]} x @param {Noise} noise @param {Fit[]} others that fit as well */
  constructor(model, x, noise, others = []) {
    this.model = model;
    this.x = x;
    this.noise = noise;
    this.others = others;
    /** True if one search of all found this motion, and what it leaves lasts. */
    this.isLone = false;
    /** True if a near camera below the pivot, with -p_psi, shows the record as well. */
    this.hasMirror = false;
    this.residuals = model.findResiduals(x);
    /** Residuals of the kept rows in deviations. */
    this.white = whiten(noise, this.residuals);
    /** What was asked for. @type {{slopes?: Slopes, independent?: number, influences?: number[][], shifts?: number[][]}} */
    this.found = {};
  }

  /** Derivatives of these, and weights of what is known. */
  get slopes() {
    this.found.slopes ??= this.findSlopes();
    return this.found.slopes;
  }

  /** @returns {Slopes} */
  findSlopes() {
    const { model, x, noise } = this;
    const columns = model.findJacobian(x, true).map((each) => whiten(noise, each));
    const priors = x.map(() => 0);
    for (const { place, deviation } of model.priors) priors[place] = deviation ** -2;
    const normal = multiplyPairs(columns).map((row, j) =>
      row.map((each, k) => each + (j === k ? priors[j] : 0)),
    );
    const sizes = normal.map((row, k) => Math.sqrt(row[k]) + TINY);
    const scaled = normal.map((row, j) => row.map((each, k) => each / sizes[j] / sizes[k]));
    const { values, vectors } = findEigen(scaled);
    const most = values[values.length - 1];
    const raised = values.map((each) => Math.max(each, NULL * most));
    return { columns, priors, sizes, values: raised, vectors };
  }

  /** The covariance of the parameters. */
  get covariance() {
    const { sizes, values, vectors } = this.slopes;
    return sizes.map((one, j) =>
      sizes.map((other, k) => {
        const sum = vectors.reduce((all, each, n) => all + (each[j] * each[k]) / values[n], 0);
        return sum / one / other;
      }),
    );
  }

  /** Whether the noise lasts from row to row. */
  get lasts() {
    return this.noise.partial[0].length > 0;
  }

  get independent() {
    this.found.independent ??= countIndependent(splitColumns(this.white, this.model.record.width));
    return this.found.independent;
  }

  /** Changes of the parameters by each kept row. */
  get influences() {
    this.found.influences ??= this.findInfluences();
    return this.found.influences;
  }

  findInfluences() {
    const { columns } = this.slopes;
    const [width, covariance] = [this.model.record.width, this.covariance];
    const scores = columns.map((each) => sumRows(each, this.white, width));
    return transpose(scores).map((row) => apply(covariance, row));
  }

  /** The deviation of a combination of the parameters, also for noise that is correlated, and rounding. @param {number[]} slope */
  findDeviation(slope) {
    const values = this.influences.map((row) => dot(row, slope));
    const robust = sumInfluences(values, this.x.length, this.independent);
    const own = apply(this.covariance, slope);
    const known = own.reduce((sum, each, k) => sum + each ** 2 * this.slopes.priors[k], 0);
    this.found.shifts ??= findShifts(this);
    return Math.sqrt(
      Math.max(robust + known, dot(slope, own), sumShifts(this.found.shifts, slope)),
    );
  }
}

/** @param {Float64Array} a @param {Float64Array} b @param {number} width */
const sumRows = (a, b, width) =>
  Array.from({ length: a.length / width }, (_, row) => {
    let sum = 0;
    for (let k = row * width; k < (row + 1) * width; k += 1) sum += a[k] * b[k];
    return sum;
  });

/** The fit, weighted by the noise that it leaves, from a motion that is near it. @param {Model} model @param {number[]} x */
export const refine = (model, x) => {
  let noise = findNoise(model, x, false);
  let found = x;
  for (let round = 0; round < ROUNDS; round += 1) {
    found = fitByNoise(model, found, noise);
    const before = noise;
    noise = findNoise(model, found, true);
    if (isSettled(before, noise)) break;
  }
  return new Fit(model, found, noise);
};

/** @param {Model} model @param {number[]} x @param {Noise} noise */
export const fitByNoise = (model, x, noise) => {
  // After many turns phases are known so much better than all else that forward differences would lead
  // along the valley by chance.
  const isLong = model.findPhase(x) > LONG;
  const weigh = (/** @type {Float64Array} */ rows) => whiten(noise, rows);
  return fitWeighted(model, x, weigh, false, STEPS, PRECISE, isLong).x;
};

/** @param {Noise} before @param {Noise} noise */
const isSettled = (before, noise) =>
  String(before.kept) === String(noise.kept) &&
  before.sigma.every((each, k) => Math.abs(each / noise.sigma[k] - 1) < SETTLED) &&
  before.partial.every(
    (each, k) =>
      each.length === noise.partial[k].length &&
      each.every((one, lag) => Math.abs(one - noise.partial[k][lag]) < SETTLED),
  );
