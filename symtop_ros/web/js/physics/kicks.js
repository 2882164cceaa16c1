// Twin of physics/kicks.py: instantaneous changes of the angular velocity at fixed attitude.

import { State } from "./state.js";

/** @typedef {import("./state.js").Vector} Vector */
/** @typedef {"spin_rate" | "spin_momentum"} Hold what is held with theta': psi', or L_z */

const LARGEST_RATE = 1e100; // rad/s

/**
 * @param {State} state
 * @param {number} rate new phi' in rad/s
 * @param {Hold} hold
 */
export const setPrecessionRate = (state, rate, hold = "spin_rate") => {
  if (state.isVertical) {
    throw new RangeError(
      "axis must be tilted (phi' is undefined on the vertical; an angular impulse works there), " +
        `got theta = ${state.angles.theta < 1 ? 0 : "pi"}`,
    );
  }
  const [x, y, z] = state.vertical;
  const change = rate - state.rates.phi;
  return add(state, [change * x, change * y, hold === "spin_momentum" ? 0 : change * z]);
};

/**
 * @param {State} state
 * @param {number} factor of phi'
 * @param {Hold} hold
 */
export const hurry = (state, factor, hold = "spin_rate") =>
  setPrecessionRate(state, factor * state.rates.phi, hold);

/**
 * @param {{Ix: number, Iz: number}} top
 * @param {State} state
 * @param {Vector} impulse in the world frame, in N m s
 */
export const applyImpulse = ({ Ix, Iz }, state, impulse) => {
  const [x, y, z] = state.toBody(impulse);
  return add(state, [x / Ix, y / Ix, z / Iz]);
};

/**
 * @param {State} state
 * @param {Vector} change of the angular velocity
 */
const add = (state, change) => {
  const omega = /** @type {Vector} */ (state.omega.map((each, k) => each + change[k]));
  if (!omega.every((each) => Math.abs(each) <= LARGEST_RATE)) {
    throw new RangeError(`angular_velocity must be at most ${LARGEST_RATE} rad/s`);
  }
  return new State(state.orientation, omega);
};
