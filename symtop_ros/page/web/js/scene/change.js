// How gravity turns L: what L becomes a moment later, and the way that the end of the axle takes.

import { NANO } from "../physics/course.js";
import { findSize, scale, subtract } from "./matrices.js";
import { findVectors } from "./vectors.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Run } from "../run/run.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Vector } from "../physics/kernel.js" */

const SHARE = 0.25; // of L, that gravity changes it by: an arrow which is seen, and is nearly straight
const LONGEST = 1; // s
const STILL = 1e-9; // of the angular velocity: less is rounding

/**
 * A time in ns in which gravity changes L by a part that is seen, with one digit in s; 0 without L.
 * @param {Course} course @param {State} state
 */
export const chooseSpan = (course, state) => {
  const wanted = (SHARE * findSize(findVectors(course, state).L)) / Math.abs(course.top.Mgl);
  return Number(Math.min(wanted || 0, LONGEST).toPrecision(1)) * NANO;
};

/** By how much L changes from a time of a run on, in a span. @param {Run} run @param {number} time ns @param {number} span ns @returns {Vector} */
export const findChange = (run, time, span) => {
  const find = (/** @type {number} */ each) => findVectors(run.find(each).course, run.at(each)).L;
  return subtract(find(time + Math.round(span)), find(time));
};

/** The direction of the end of the axle; zero if it rests. @param {State} state @returns {Vector} */
export const findWay = (state) => {
  const [x, y, z] = state.omega;
  const velocity = state.toWorld([y, -x, 0]);
  const size = Math.hypot(x, y);
  return size > STILL * Math.hypot(x, y, z) ? scale(velocity, 1 / size) : [0, 0, 0];
};
