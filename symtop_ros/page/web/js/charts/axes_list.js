// Quantities that the chart with axes of choice can show.

import { findEnergies, findRest, findTiltAcceleration } from "../physics/formulas.js";
import { NANO } from "../physics/course.js";
import { findVectors } from "../scene/vectors.js";
import { phrase } from "../words/wording.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Vector } from "../physics/kernel.js" */
/** @import { Energies } from "../physics/formulas.js" */
/** @typedef {(time: number, state: State, course: Course) => number} Pick */
/** @typedef {{unit: string, pick: Pick}} Quantity an angle if its unit is rad */

const MILLI = 1000;

/** @param {string} unit @param {Pick} pick @returns {Quantity} */
const list = (unit, pick) => ({ unit, pick });

/** @param {"phi" | "theta" | "psi"} id */
const listAngle = (id) => list("rad", (_, { angles }) => angles[id]);

/** @param {"phi" | "theta" | "psi"} id */
const listRate = (id) => list("rad/s", (_, { rates }) => rates[id]);

/** @param {(parts: Energies) => number} part */
const listEnergy = (part) =>
  list("mJ", (_, state, { top }) => MILLI * part(findEnergies(top, state)));

/** @param {(L: Vector) => number} part in space */
const listMomentum = (part) =>
  list("N m s", (_, state, course) => part(findVectors(course, state).L));

/** @type {{[id: string]: Quantity}} */
export const QUANTITIES = {
  time: list("s", (time) => time / NANO),
  theta: listAngle("theta"),
  phi: listAngle("phi"),
  psi: listAngle("psi"),
  theta_dot: listRate("theta"),
  phi_dot: listRate("phi"),
  psi_dot: listRate("psi"),
  theta_ddot: list("rad/s\u00b2", (_, { angles, rates }, { top }) =>
    findTiltAcceleration(top, angles.theta, rates.phi, rates.psi),
  ),
  weight: listEnergy(({ weight }) => weight),
  precession: listEnergy(({ precession }) => precession),
  nutation: listEnergy(({ nutation }) => nutation),
  rest: listEnergy(findRest),
  L_x: listMomentum(([x]) => x),
  L_y: listMomentum(([, y]) => y),
  L_vertical: listMomentum(([, , z]) => z),
  L_axis: list("N m s", (_, { omega }, { top }) => top.Iz * omega[2]),
  L_size: listMomentum((L) => Math.hypot(...L)),
};

/** @param {string} id */
export const nameQuantity = (id) => phrase(`quantity.${id}`);
