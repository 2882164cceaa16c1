// What the buttons that are held would do in a second, from the state after the last act on: computed, as
// neither "higher" nor "faster" holds for every top.

import { NANO } from "../physics/course.js";
import { findPush, findTorque, PUSH_RATE } from "../run/acts.js";
import { compareMeans } from "./pushes.js";
import { phrase } from "./wording.js";

/** @import { Course } from "../physics/course.js" */

// Of an integration for a text, some tenths of a second; what takes more is left unsaid.
const STEPS = 10_000;

/** A second of pushes along the precession. @param {Course} course */
const pushForASecond = (course) => {
  const impulse = findPush(course);
  let pushed = course;
  for (let k = 0; k < PUSH_RATE; k++) {
    const state = k ? pushed.at(NANO / PUSH_RATE) : pushed.start;
    pushed = pushed.continueFree(state.kick(course.top, "axle", [impulse]));
  }
  return pushed;
};

/** A second of a torque about the vertical. @param {Course} course @returns {Course | null} */
const turnForASecond = (course) => {
  const turned = course.continue(course.start, { torque: [0, 0, findTorque(course)] });
  if (turned.reach(NANO, STEPS) < NANO) return null;
  return course.continueFree(turned.at(NANO));
};

/** @param {Course | null} course @param {(course: Course) => Course | null} act */
const say = (course, act) => {
  if (!course || course.isDriven || course.top.Mgl === 0) return "";
  try {
    const after = act(course);
    return after ? phrase("outlook", compareMeans(course, after)) : "";
  } catch (error) {
    if (error instanceof RangeError) return ""; // on the vertical there is no way along
    throw error;
  }
};

/** The sentences beside the buttons; empty where nothing is known. @param {Course | null} course */
export const describeOutlooks = (course) => ({
  press: say(course, pushForASecond),
  torque: say(course, turnForASecond),
});
