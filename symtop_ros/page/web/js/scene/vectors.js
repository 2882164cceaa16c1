// The vectors of a state that the scene draws, in the world frame.

import { NAMES } from "../physics/records.js";
import { add } from "./matrices.js";
import { findFrameTorques } from "../physics/formulas.js";

/** @type {string[]} */
const KINDS = NAMES.friction_kind;

/** @import { State } from "../physics/state.js" */
/** @import { Vector } from "../physics/kernel.js" */

/**
 * @param {import("../physics/course.js").Course} course
 * @param {State} state
 * @returns {{L: Vector, omega: Vector, torque: Vector}}
 */
export const findVectors = ({ top: { Ix, Iz, Mgl }, friction, torque, clamped }, state) => {
  const [x, y, z] = state.omega;
  const [a, b] = state.toWorld([0, 0, Mgl]);
  const [axial, transverse] = ["axial", "transverse"].map((each) => friction[KINDS.indexOf(each)]);
  const damping = state.toWorld([-transverse * x, -transverse * y, -axial * z]);
  // p_psi times the velocity of the axle: derivation.md, section 11
  const held = clamped ? Iz * z : 0;
  const hand = state.toWorld([held * y, -held * x, 0]);
  return {
    L: state.toWorld([Ix * x, Ix * y, Iz * z]),
    omega: state.toWorld(state.omega),
    torque: add(add(add([-b, a, 0], damping), torque), hand),
  };
};

/**
 * The torques along the line of nodes for an observer who precesses with the top.
 * @param {import("../physics/kernel.js").Top} top @param {State} state
 */
export const findTorques = (top, state) => {
  const { phi, psi } = state.rates;
  const torques = findFrameTorques(top, state.angles.theta, phi, psi);
  const { gravity, coriolis: Coriolis, centrifugal, total: sum } = torques;
  return { gravity, Coriolis, centrifugal, sum };
};
