// The fit of a record: two searches, more if what is left is no noise, and other motions.
//
// Twin of truth/fit/fitting.py and aliases.py.

import { checkFit } from "./check.js";
import { dot } from "./linear.js";
import { findAxis, findVertical } from "./many.js";
import { whiten } from "./noise.js";
import { Fit, fitByNoise, refine } from "./refine.js";
import { AGAIN, EFFORTS, expand, search } from "./search.js";
import { Starts } from "./starts.js";
import { findMedian } from "./statistics.js";
import { mirrorView, restate, turnCamera } from "./twins.js";
import { SPARSE, countRows, isAlias } from "./values.js";

/** @import { Many, Thrown } from "./many.js" */
/** @import { Record } from "./record.js" */
/** @import { Candidate } from "./search.js" */

const SAME = 1.001; // costs of two searches that found one minimum
const SURE = 2; // searches that have to find it
const FARTHEST = 6; // deviations; a residual beyond it counts as this
const CLEAR = 25; // squares of deviations by which a motion fits worse than another
// deviations of a nearness; without it the squares would grow by 144, far above CLEAR
const SURELY_NEAR = 12;
const DIFFERENT = 0.02; // of p_psi/Ix; motions that are closer are one
const ALIKE = 1.1; // costs of motions that fit as well, at most
const NEAR = Array.from({ length: 33 }, (_, k) => 0.8 + (0.4 * k) / 32); // of p_psi/Ix of a start

/**
 * The motion that explains a record.
 * @param {Many} many @param {Record} record @param {(part: number) => void} report is called with the part that is done
 */
export const fitMotion = (many, record, report) => {
  let { found, rivals, isLone } = seek(many, record, report);
  if (countRows(found) < 2 * SPARSE) {
    const list = listAliasStarts(found);
    const ends = expand(search(record.plain, EFFORTS[AGAIN], list), record);
    rivals = [...rivals, ...ends];
    found = chooseBetter(found, ends, record);
  }
  const best = settle(chooseTwin(found), rivals);
  best.isLone = isLone && best.lasts; // what is left of a wrong minimum lasts
  return best;
};

/** The best motion, all that searches found, and whether one alone found it. @param {Many} many @param {Record} record @param {(part: number) => void} report */
const seek = (many, record, report) => {
  const starts = new Starts(many);
  /** @type {Fit | null} */
  let found = null;
  /** @type {Candidate[]} */
  let rivals = [];
  /** @type {number[]} */
  const bests = [];
  const agree = () => bests.filter((each) => each <= SAME * Math.min(...bests)).length;
  for (const [number, effort] of EFFORTS.entries()) {
    const tell = (/** @type {number} */ part) => report((number + part) / (EFFORTS.length + 1));
    const ends = expand(
      search(record.plain, effort, (part) => starts.list(part, tell)),
      record,
    );
    rivals = [...rivals, ...ends];
    bests.push(Math.min(...ends.map(({ cost }) => cost)));
    if (!found || bests[number] <= Math.min(...bests)) found = chooseBetter(found, ends, record);
    // Noise that lasts may be the motion that a wrong minimum leaves: then three have to find it.
    if (agree() >= SURE + Number(found.lasts) && checkFit(found).verdict === "holds") break;
  }
  return { found: /** @type {Fit} */ (found), rivals, isLone: agree() < SURE };
};

/** @param {Fit | null} fit @param {Candidate[]} ends @param {Record} record */
const chooseBetter = (fit, ends, record) => {
  const best = ends.reduce((a, b) => (b.cost < a.cost ? b : a));
  const other = refine(best.model.move(record), best.x);
  return !fit || isBetter(other, fit) ? other : fit;
};

/** Whether a fit leaves less than another, by the noise of either. @param {Fit} other @param {Fit} fit */
const isBetter = (other, fit) => {
  const gains = [other, fit].map(
    (each) => sumFar(each, fit.residuals) - sumFar(each, other.residuals),
  );
  if (gains[0] * gains[1] > 0) return gains[0] > 0;
  const measure = (/** @type {Fit} */ { residuals }) => findMedian(residuals.map(Math.abs));
  return measure(other) < 0.999 * measure(fit);
};

/** The squares of residuals in deviations, each at most FARTHEST. @param {Fit} fit @param {Float64Array} residuals */
const sumFar = ({ noise }, residuals) => {
  const rows = whiten(noise, residuals).map((each) => Math.min(Math.abs(each), FARTHEST));
  return dot(rows, rows);
};

/** The best of a fit and of the motions that fit as well, with the others. @param {Fit} fit @param {Candidate[]} rivals */
const settle = (fit, rivals) => {
  let [best, others] = [fit, listOthers(fit, rivals)];
  for (const each of others) {
    const other = refine(each.model, each.x);
    if (isBetter(other, best)) best = other;
  }
  if (best !== fit) others = listOthers(best, rivals);
  const slower = others.find((each) => isAlias(best, each));
  if (slower) {
    best = chooseTwin(refine(slower.model, slower.x));
    others = listOthers(best, rivals);
  }
  const found = new Fit(best.model, best.x, best.noise, others);
  found.hasMirror = best.hasMirror;
  return found;
};

/** The usual one of exact twins: a camera is upright and high. @param {Fit} fit */
const chooseTwin = (fit) => {
  const { record, place } = fit.model;
  if (record.kind !== "pixels") return fit;
  return chooseSide(Math.cos(fit.x[place.roll]) < 0 ? take(fit, turnCamera) : fit);
};

/** @param {Fit} fit @param {typeof mirrorView} turn */
const take = (fit, turn) => {
  const { many, record } = fit.model;
  const { motion, camera } = turn(fit.model.read(fit.x), fit.model.findCamera(fit.x));
  const { model, x } = restate(many, record, motion, camera);
  return refine(model, x);
};

/**
 * The fit with a camera above the pivot, unless the record shows that it was below.
 *
 * Only what is nearer and larger shows the side. That a near camera is looked for decides nothing: of a
 * film from far away both sides fit as well.
 * @param {Fit} fit
 */
const chooseSide = (fit) => {
  const { record, place } = fit.model;
  const isBelow = fit.x[place.elevation] < 0;
  if (!record.hasPerspective) return isBelow ? take(fit, mirrorView) : fit;
  const deviation = fit.findDeviation(fit.x.map((_, k) => Number(k === place.nearness)));
  if (fit.x[place.nearness] > SURELY_NEAR * deviation) return fit;
  const other = take(fit, mirrorView);
  if (sumFar(fit, other.residuals) - sumFar(fit, fit.residuals) >= CLEAR) return fit;
  const best = isBelow ? other : fit;
  best.hasMirror = true;
  return best;
};

/** The number that is the same for exact twins. @param {{model: Fit["model"], x: number[]}} found */
const findMark = ({ model, x }) => {
  const p = x[model.place["p_psi/Ix"]];
  return model.record.kind === "axis" ? p : Math.abs(p);
};

/** Other motions that fit a record as well. @param {Fit} fit @param {Candidate[]} rivals */
const listOthers = (fit, rivals) => {
  const [own, best] = [sumFar(fit, fit.residuals), Math.min(...rivals.map(({ cost }) => cost))];
  const marks = [findMark(fit)];
  /** @type {Fit[]} */
  const found = [];
  const differ = (/** @type {number} */ mark) => (/** @type {number} */ other) =>
    Math.abs(mark / other - 1) >= DIFFERENT;
  for (const each of rivals.toSorted((a, b) => a.cost - b.cost)) {
    if (each.cost > ALIKE * best) break;
    const mark = findMark(each);
    if (!marks.every(differ(mark))) continue;
    const model = each.model.move(fit.model.record);
    const other = new Fit(model, fitByNoise(model, each.x, fit.noise), fit.noise);
    if (sumFar(fit, other.residuals) >= own + CLEAR) continue;
    marks.push(mark);
    found.push(chooseTwin(other));
  }
  return found.filter((each) => differ(findMark(each))(marks[0]));
};

/**
 * Starts whose nutation has another frequency and shows the same rows: 1/step - f or 1/step + f.
 * @param {Fit} fit
 */
const listAliasStarts = (fit) => {
  const { many, record } = fit.model;
  const motion = fit.model.read(fit.x);
  const rates = many.findRates(motion);
  const [turning, rate] = [rates.mean_precession_rate, (2 * Math.PI) / rates.nutation_period];
  const sampling = (2 * Math.PI) / record.step;
  const ratios = [(rate - sampling) / rate, (rate + sampling) / rate];
  const found = ratios.flatMap((ratio) =>
    NEAR.map((near) => {
      const moved = hastenNutation(motion, ratio * near, turning);
      return restate(many, record.plain, moved, fit.model.findCamera(fit.x));
    }),
  );
  return (/** @type {Record} */ part) =>
    found.map(({ model, x }) => ({ model: model.move(part), x }));
};

/** A motion whose p_psi and velocity of nutation are larger by a ratio. @param {Thrown} motion @param {number} ratio @param {number} turning @returns {Thrown} */
const hastenNutation = ({ q, omega: [wx, wy, p] }, ratio, turning) => {
  const [[x, y], [, , z]] = [findVertical(q), findAxis(q)];
  const mean = [turning * x, turning * y];
  return {
    weight: p * ratio * turning - z * turning ** 2,
    q,
    omega: [mean[0] + ratio * (wx - mean[0]), mean[1] + ratio * (wy - mean[1]), p * ratio],
  };
};
