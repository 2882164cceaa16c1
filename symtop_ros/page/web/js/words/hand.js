// What a hand feels of the torque, or of the push, that it gives to the top in its gimbal.

import { findAngularMomentum, findClampTorque } from "../physics/formulas.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Top } from "../physics/kernel.js" */
/** @import { Moment } from "../run/run.js" */
/**
 * The outer ring turns about the vertical: a hand at it gives that part, and the bearing in the stand
 * the rest. A torque in N m, or the impulse of a push in N m s; and the most of all of it that there will
 * be, up to which bars are drawn.
 * @typedef {{kind: "clamp" | "torque" | "push", ring: number, stand: number, most: number}} Hand
 */

/** @param {Hand["kind"]} kind @param {number[]} torque @param {number} most @returns {Hand} */
const share = (kind, [x, y, z], most = Math.hypot(x, y, z)) => ({
  ...{ kind, ring: z, stand: Math.hypot(x, y), most },
});

/** The torque of a clamp where the weight is lowest: p_psi theta'. @param {Top} top @param {State} state */
const findMostOfClamp = ({ Ix, Iz, Mgl }, { omega: [x, y, z], vertical }) => {
  const fall = (2 * (Math.abs(Mgl) + Mgl * vertical[2])) / Ix; // what theta'^2 gains
  return Math.abs(Iz * z) * Math.sqrt(x * x + y * y + Math.max(fall, 0));
};

/** What gave a push; null if the event is none. @param {Moment} event @returns {Hand | null} */
export const findPusher = ({ kind, course: { top, start }, before }) => {
  if (kind !== "kick" || !before) return null;
  const was = findAngularMomentum(top, before);
  const gained = findAngularMomentum(top, start).map((each, k) => each - was[k]);
  return share("push", gained);
};

/**
 * What acts on the top now besides gravity and friction, or has pushed it last; null if nothing does.
 * @param {Course} course @param {State} state of now @param {Hand | null} pusher
 */
export const findHand = ({ clamped, torque, top }, state, pusher) => {
  if (clamped) return share("clamp", findClampTorque(top, state), findMostOfClamp(top, state));
  return torque.some((each) => each !== 0) ? share("torque", torque) : pusher;
};
