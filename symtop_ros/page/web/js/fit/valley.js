// The valley of motions that fit about as well: whether deviations hold along it.
//
// Twin of truth/fit/valley.py, whose text says why steps go back to the floor of the valley.

import { dot } from "./linear.js";
import { sumSquares } from "./model.js";
import { whiten } from "./noise.js";

/** @import { Fit } from "./refine.js" */

const STRAIGHT = 2; // times the growth of squares
const GIVEN = 0.5; // part of the information on a step
const CURVED = 0.1; // part of a variance
const BENT = 0.3; // deviations
const DESCENTS = 4;
const FAR = 3; // deviations
const SIDES = [1, -1];

/** @param {number} growth of squares, over the one that is right */
const isNear = (growth) => growth > 1 / STRAIGHT && growth < STRAIGHT;

export class Valley {
  /** @param {Fit} fit */
  constructor(fit) {
    this.fit = fit;
    const { values, vectors, sizes, priors } = fit.slopes;
    this.steps = vectors.map((each, k) =>
      each.map((part, j) => part / Math.sqrt(values[k]) / sizes[j]),
    );
    this.own = this.sumSquares(fit.x);
    const left = this.steps.map((step) => {
      const isGiven =
        step.reduce((sum, each, k) => sum + each ** 2 * priors[k], 0) + this.measureFixed(step) >
        GIVEN;
      const grown = SIDES.map((side) => this.measureGrowth(this.move(step, side)));
      return !isGiven && !isNear((grown[0] + grown[1]) / 2);
    });
    /** Motions on the floor to both sides, by the numbers of steps. */
    this.floors = left.map((isLeft, k) =>
      isLeft ? SIDES.map((side) => this.descend(this.move(this.steps[k], side * FAR), k)) : null,
    );
    this.isCurved = this.floors.map(
      (ends) => ends !== null && !ends.every((each) => isNear(this.measureGrowth(each) / FAR ** 2)),
    );
  }

  /** The information on a step by columns whose rows have one error. @param {number[]} step */
  measureFixed(step) {
    const { model, white, slopes } = this.fit;
    const { fixed, width } = model.record;
    let sum = 0;
    for (let k = 0; fixed.some(Boolean) && k < white.length; k += 1)
      if (fixed[k % width])
        sum += slopes.columns.reduce((all, each, j) => all + each[k] * step[j], 0) ** 2;
    return sum;
  }

  /** Whether the deviation of a number holds. @param {number[]} slope @param {(x: number[]) => number} of */
  isStraight(slope, of) {
    const { values, vectors, sizes } = this.fit.slopes;
    const parts = vectors.map((each, k) => {
      const sum = each.reduce((all, part, j) => all + (part * slope[j]) / sizes[j], 0);
      return sum ** 2 / values[k];
    });
    const all = parts.reduce((a, b) => a + b, 0);
    const curved = parts.reduce((sum, each, k) => sum + (this.isCurved[k] ? each : 0), 0);
    if (curved > CURVED * all) return false;
    const own = of(this.fit.x);
    const bends = this.floors.flatMap((ends) =>
      ends ? [(of(ends[0]) + of(ends[1])) / 2 - own] : [],
    );
    return sumSquares(bends) <= (BENT * FAR ** 2) ** 2 * all;
  }

  /** @param {number[]} step @param {number} by */
  move(step, by) {
    return this.fit.x.map((each, k) => each + by * step[k]);
  }

  /** @param {number[]} x */
  sumSquares(x) {
    const { model, noise } = this.fit;
    const left = whiten(noise, model.findResiduals(x));
    return dot(left, left) + sumSquares(model.findErrors(x));
  }

  /** @param {number[]} x */
  measureGrowth(x) {
    return this.sumSquares(x) - this.own;
  }

  /** The lowest point that the directions that are known better than the k-th reach. @param {number[]} x @param {number} k */
  descend(x, k) {
    const { model, noise, slopes } = this.fit;
    const { columns, values, vectors, sizes } = slopes;
    let found = x;
    for (let step = 0; step < DESCENTS; step += 1) {
      const left = whiten(noise, model.findResiduals(found));
      const slope = columns.map((each) => dot(each, left));
      for (const { place, value, deviation } of model.priors)
        slope[place] += (found[place] - value) / deviation ** 2;
      const by = found.map(() => 0);
      for (let n = k + 1; n < values.length; n += 1) {
        const part = vectors[n].reduce((sum, each, j) => sum + (each * slope[j]) / sizes[j], 0);
        for (let j = 0; j < by.length; j += 1)
          by[j] += (vectors[n][j] / sizes[j]) * (part / values[n]);
      }
      found = found.map((each, j) => each - by[j]);
    }
    return found;
  }
}
