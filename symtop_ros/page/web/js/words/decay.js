// What friction at the spin does to the precession, as the record that a node has.

import { NANO } from "../physics/course.js";

/** @import { Course } from "../physics/course.js" */

const LONGEST = 2e4; // turns and decays of 1 rad that are integrated for a sentence
const TELLING = 1.05; // ratio of the rates; a smaller one is no change that is seen

/** @typedef {{kind: string, seconds: number, before: number, after: number}} Decay */
/** Each once: the texts are written four times a second. @type {WeakMap<Course, Decay | null>} */
const known = new WeakMap();

/** From the start of a course on; null if nothing can be said. @param {Course} course */
export const findDecay = (course) => {
  if (!known.has(course)) known.set(course, computeDecay(course));
  return known.get(course) ?? null;
};

/** @param {Course} course @returns {Decay | null} */
const computeDecay = (course) => {
  const { top, start, friction, torque, pushes, clamped } = course;
  const [axial, transverse] = friction;
  if (!axial || torque.some((each) => each !== 0) || pushes || clamped) return null;
  const seconds = (top.Iz * Math.LN2) / axial;
  const rate = Math.max(...start.omega.map(Math.abs)) + transverse / top.Ix;
  if (!(rate * seconds <= LONGEST)) return null;
  const then = course.at(Math.floor(seconds * NANO));
  const [before, after] = [start, then].map(
    (state) => course.continueFree(state).motion.rates.mean_precession_rate,
  );
  const [low, high] = [before, after].map(Math.abs).sort((a, b) => a - b);
  if (!(before * after > 0 && high > TELLING * low)) return null;
  return { kind: Math.abs(after) > Math.abs(before) ? "faster" : "slower", seconds, before, after };
};
