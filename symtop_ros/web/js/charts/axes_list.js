// Quantities that the chart with axes of choice can show.

import { findEnergies, findRest, findTiltAcceleration } from "./formulas.js";
import { NANO } from "../physics/course.js";
import { findVectors } from "../scene/vectors.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Vector } from "../physics/kernel.js" */
/** @import { Energies } from "./formulas.js" */
/** @typedef {(time: number, state: State, course: Course) => number} Pick */
/** @typedef {{name: string, unit: string, isAngle?: boolean, pick: Pick}} Quantity */

const MILLI = 1000;

/** @param {string} name @param {string} unit @param {Pick} pick @returns {Quantity} */
const list = (name, unit, pick) => ({ name, unit, pick });

/** @param {string} name @param {"phi" | "theta" | "psi"} id @returns {Quantity} */
const listAngle = (name, id) => ({
  ...list(name, "rad", (_, { angles }) => angles[id]),
  isAngle: true,
});

/** @param {string} name @param {"phi" | "theta" | "psi"} id */
const listRate = (name, id) => list(name, "rad/s", (_, { rates }) => rates[id]);

/** @param {string} name @param {(parts: Energies) => number} part */
const listEnergy = (name, part) =>
  list(name, "mJ", (_, state, { top }) => MILLI * part(findEnergies(top, state)));

/** @param {string} name @param {(L: Vector) => number} part in space */
const listMomentum = (name, part) =>
  list(name, "N m s", (_, state, course) => part(findVectors(course, state).L));

/** @type {{[id: string]: Quantity}} */
export const QUANTITIES = {
  time: list("time", "s", (time) => time / NANO),
  theta: listAngle("tilt theta", "theta"),
  phi: listAngle("precession phi", "phi"),
  psi: listAngle("spin psi", "psi"),
  theta_dot: listRate("tilt rate theta'", "theta"),
  phi_dot: listRate("precession rate phi'", "phi"),
  psi_dot: listRate("spin rate psi'", "psi"),
  theta_ddot: list("tilt acceleration theta''", "rad/s\u00b2", (_, { angles, rates }, { top }) =>
    findTiltAcceleration(top, angles.theta, rates.phi, rates.psi),
  ),
  weight: listEnergy("energy of the weight", ({ weight }) => weight),
  precession: listEnergy("energy of the precession", ({ precession }) => precession),
  nutation: listEnergy("energy of the nutation", ({ nutation }) => nutation),
  rest: listEnergy("energy E'", findRest),
  L_x: listMomentum("L along x, in space", ([x]) => x),
  L_y: listMomentum("L along y, in space", ([, y]) => y),
  L_vertical: listMomentum("L along the vertical", ([, , z]) => z),
  L_axis: list("L along the axis", "N m s", (_, { omega }, { top }) => top.Iz * omega[2]),
  L_size: listMomentum("size of L", (L) => Math.hypot(...L)),
};
