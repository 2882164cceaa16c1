// What a series of pushes on the axle has done up to a time, as records: for the headline, and the one
// that Python's `Pushed` has.

import { findConstants } from "../physics/formulas.js";
import { NANO } from "../physics/course.js";
import { MILLI, nameGain } from "./ledger.js";
import { judge } from "./verdict.js";

/** @import { Run, Moment } from "../run/run.js" */
/** @import { Course } from "../physics/course.js" */

/** Means of phi' and of the potential energy, before and after. @param {Course} former @param {Course} free */
export const compareMeans = (former, free) => {
  const [before, after] = [former, free].map((each) => each.motion.rates);
  const [was, is] = [before, after].map((each) => each.mean_precession_rate);
  const weight = MILLI * free.top.Mgl * (after.mean_cosine - before.mean_cosine);
  return {
    means: Number.isNaN(was + is) ? null : { before: was, after: is },
    weight: nameGain(weight, { weight: MILLI * free.top.Mgl, precession: 0 }),
  };
};

/**
 * Null after something else, as a torque, or under friction.
 * @param {Run} run
 * @param {Moment} first of the pushes
 * @param {number} time ns
 * @param {Course} free the motion of now
 */
export const describePushes = (run, first, time, free) => {
  const { before, course } = first;
  if (!before || course.isDriven || run.findEvent(time) !== first) return null;
  const last = run.find(time);
  const number = last.number ?? 1;
  const { top } = free;
  const former = free.continueFree(before);
  const [energy, now] = [before, free.start].map((each) => findConstants(top, each).energy);
  const outcome = {
    number,
    duration: number > 1 ? (last.time - first.time) / NANO : null,
    driven: false,
    turning_angles: free.motion.turning_angles,
    former_angles: former.motion.turning_angles,
    work: MILLI * (now - energy),
    ...compareMeans(former, free),
  };
  const because = judge(free).cause;
  return { headline: { ...outcome, kind: "pushed" }, name: "push", outcome, because };
};
