// The search for the motion: starts that are best on longer and longer parts of a record.
//
// Twin of truth/fit/search.py and sides.py. On a short part the valleys of minima are wide, and each
// longer part begins inside the valley of the last one.

import { minimise } from "./least_squares.js";
import { findMedian } from "./statistics.js";
import { mirrorView, restate } from "./twins.js";

/** @import { Model } from "./model.js" */
/** @import { Record } from "./record.js" */
/** @import { Start } from "./starts.js" */
/** @typedef {Start & {cost: number}} Candidate */
/** The size of a search: those kept, and rows of the first part. @typedef {{kept: number, first: number, share: number}} Effort */

const GROWTH = 1.7; // of a part
const BROAD = 3; // scales of the residuals at which starts are compared
const SOFT = 0.1; // of the spread of the values: the first scale of a robust loss
const SAME = 1e-4; // relative difference of the costs of one minimum
const NEAR = 1e-6; // relative change of a cost by the last step
const NEAREST = 0.9; // length of the axis in distances of the camera
const [FEW, MANY] = [12, 40]; // steps
const SIDES = 3; // motions of a search that are improved with their twins
const SLIGHT = 0.05; // nearness of a start
/** The first part of the second search is long: in a quick record 40 rows show no nutation. @type {Effort[]} */
export const EFFORTS = [
  { kept: 4, first: 40, share: 0 },
  { kept: 4, first: 40, share: 0.35 },
  { kept: 6, first: 24, share: 0 },
  { kept: 8, first: 60, share: 0.2 },
];
export const AGAIN = 2; // the effort with which other starts are tried

/** The parameters within their limits. @param {Model} model */
const limit = (model) => {
  const { elevation, nearness } = model.place;
  return (/** @type {number[]} */ x) => {
    const clipped = [...x];
    const clip = (
      /** @type {number} */ place,
      /** @type {number} */ low,
      /** @type {number} */ high,
    ) => {
      if (place !== undefined) clipped[place] = Math.min(Math.max(x[place], low), high);
    };
    clip(elevation, -Math.PI / 2, Math.PI / 2);
    clip(nearness, 0, NEAREST);
    return clipped;
  };
};

/**
 * The least squares of residuals in deviations and of what is known.
 * @param {Model} model @param {number[]} x
 * @param {(rows: Float64Array) => Float64Array} weigh @param {boolean} isSoft
 * @param {number} most @param {number} precise @param {boolean} central
 */
export const fitWeighted = (model, x, weigh, isSoft, most, precise, central = false) => {
  const { priors } = model;
  const extend = (/** @type {Float64Array} */ rows, /** @type {number[]} */ more) =>
    more.length ? Float64Array.from([...rows, ...more]) : rows;
  const find = (/** @type {number[]} */ x) =>
    extend(weigh(model.findResiduals(x)), model.findErrors(x));
  const derive = (/** @type {number[]} */ x) =>
    model.findJacobian(x, central).map((each, k) =>
      extend(
        weigh(each),
        priors.map(({ place, deviation }) => (place === k ? 1 / deviation : 0)),
      ),
    );
  const problem = { find, derive, clip: limit(model), isSoft };
  return minimise(problem, x, most, precise);
};

/** The minimum near a start, by a loss in which outliers count little. @param {Start} start @param {number} most @returns {Candidate} */
const improve = ({ model, x }, most) => {
  const scale = SOFT * findMedian(model.record.spreads) + 1e-12;
  const weigh = (/** @type {Float64Array} */ rows) => rows.map((each) => each / scale);
  return { model, ...fitWeighted(model, x, weigh, true, most, NEAR) };
};

/** @param {Candidate[]} found in order @param {number} most each minimum once */
const dropTwins = (found, most) => {
  /** @type {Candidate[]} */
  const best = [];
  for (const each of found)
    if (best.every(({ cost }) => Math.abs(each.cost - cost) > SAME * cost)) best.push(each);
  return best.slice(0, most);
};

/** @param {Candidate[]} found */
const order = (found) => found.sort((a, b) => a.cost - b.cost);

/**
 * Motions that fit the whole record, the best first.
 * @param {Record} record @param {Effort} effort @param {(part: Record) => Start[]} list starts of a part
 */
export const search = (record, effort, list) => {
  const smooth = record.smooth;
  let count = Math.min(
    record.count,
    Math.max(effort.first, Math.floor(effort.share * record.count)),
  );
  let best = choose(list(smooth.cut(count)), smooth.cut(count), MANY);
  for (let most = FEW; ; most = MANY) {
    const part = smooth.cut(count);
    const tried = best.map(({ model, x }) => improve({ model: model.move(part), x }, most));
    const found = dropTwins(order(tried), effort.kept);
    if (count >= record.count && most > FEW) return found;
    best = found;
    count = Math.min(record.count, Math.floor(count * GROWTH));
  }
};

/** The starts that are nearest to a part of a record. @param {Start[]} starts @param {Record} part @param {number} most */
const choose = (starts, part, most) => {
  const wide = BROAD * findMedian(part.spreads);
  const rated = starts.map(({ model, x }) => {
    const left = model.move(part).findResiduals(x);
    return { model, x, cost: left.reduce((sum, each) => sum + Math.min(Math.abs(each), wide), 0) };
  });
  return order(rated).slice(0, most);
};

/** Candidates of a plain record as those of the whole one, seen from both sides. @param {Candidate[]} found @param {Record} record */
export const expand = (found, record) => {
  if (!record.hasPerspective) return found;
  const { smooth } = record;
  const tried = found.slice(0, SIDES).flatMap(({ model, x }) => {
    const [motion, camera] = [model.read(x), model.findCamera(x)];
    const mirrored = mirrorView(motion, camera);
    return [{ motion, camera }, mirrored].map((side) => {
      const seen = { ...side.camera, nearness: SLIGHT };
      return improve(restate(model.many, smooth, side.motion, seen), MANY);
    });
  });
  return dropTwins(order(tried), tried.length);
};
