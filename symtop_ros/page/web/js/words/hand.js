// What a hand feels of the torque, or of the push, that it gives to the top in its gimbal.

import { findAngularMomentum, findClampTorque } from "../physics/formulas.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Moment } from "../run/run.js" */
/**
 * The outer ring turns about the vertical: a hand at it gives that part, and the bearing in the stand
 * the rest. A torque in N m, or the impulse of a push in N m s.
 * @typedef {{kind: "clamp" | "torque" | "push", ring: number, stand: number}} Hand
 */

/** @param {Hand["kind"]} kind @param {number[]} torque @returns {Hand} */
const share = (kind, [x, y, z]) => ({ kind, ring: z, stand: Math.hypot(x, y) });

/**
 * What acts on the top now besides gravity and friction, or the last push; null if nothing does.
 * @param {Course} course @param {State} state of now @param {Moment} announced the last event
 * @returns {Hand | null}
 */
export const findHand = (course, state, announced) => {
  if (course.clamped) return share("clamp", findClampTorque(course.top, state));
  if (course.torque.some((each) => each !== 0)) return share("torque", course.torque);
  const { kind, before } = announced;
  if (kind !== "kick" || !before) return null;
  const after = findAngularMomentum(announced.course.top, announced.course.start);
  const momentum = findAngularMomentum(announced.course.top, before);
  return share(
    "push",
    after.map((each, k) => each - momentum[k]),
  );
};
