// Quantities that the chart with axes of choice can show.

import { findEnergies, findRest, findTiltAcceleration } from "./formulas.js";
import { NANO } from "../physics/course.js";
import { findVectors } from "../scene/vectors.js";

/** @typedef {import("../physics/course.js").Course} Course */
/** @typedef {import("../physics/state.js").State} State */
/** @typedef {(time: number, state: State, course: Course) => number} Pick */
/** @typedef {{name: string, unit: string, isAngle?: boolean, pick: Pick}} Quantity */

const MILLI = 1000;

/** @type {{[id: string]: Quantity}} */
export const QUANTITIES = {
  time: { name: "time", unit: "s", pick: (time) => time / NANO },
  theta: { name: "tilt theta", unit: "rad", isAngle: true, pick: (_, { angles }) => angles.theta },
  phi: { name: "precession phi", unit: "rad", isAngle: true, pick: (_, { angles }) => angles.phi },
  psi: { name: "spin psi", unit: "rad", isAngle: true, pick: (_, { angles }) => angles.psi },
  theta_dot: { name: "tilt rate theta'", unit: "rad/s", pick: (_, { rates }) => rates.theta },
  phi_dot: { name: "precession rate phi'", unit: "rad/s", pick: (_, { rates }) => rates.phi },
  psi_dot: { name: "spin rate psi'", unit: "rad/s", pick: (_, { rates }) => rates.psi },
  theta_ddot: {
    name: "tilt acceleration theta''",
    unit: "rad/s\u00b2",
    pick: (_, { angles, rates }, { top }) =>
      findTiltAcceleration(top, angles.theta, rates.phi, rates.psi),
  },
  weight: {
    name: "energy of the weight",
    unit: "mJ",
    pick: (_, state, { top }) => MILLI * findEnergies(top, state).weight,
  },
  precession: {
    name: "energy of the precession",
    unit: "mJ",
    pick: (_, state, { top }) => MILLI * findEnergies(top, state).precession,
  },
  nutation: {
    name: "energy of the nutation",
    unit: "mJ",
    pick: (_, state, { top }) => MILLI * findEnergies(top, state).nutation,
  },
  rest: {
    name: "energy E'",
    unit: "mJ",
    pick: (_, state, { top }) => MILLI * findRest(findEnergies(top, state)),
  },
  L_x: {
    name: "L along x, in space",
    unit: "N m s",
    pick: (_, state, course) => findVectors(course, state).L[0],
  },
  L_y: {
    name: "L along y, in space",
    unit: "N m s",
    pick: (_, state, course) => findVectors(course, state).L[1],
  },
  L_vertical: {
    name: "L along the vertical",
    unit: "N m s",
    pick: (_, state, course) => findVectors(course, state).L[2],
  },
  L_axis: {
    name: "L along the axis",
    unit: "N m s",
    pick: (_, { omega }, { top }) => top.Iz * omega[2],
  },
  L_size: {
    name: "size of L",
    unit: "N m s",
    pick: (_, state, course) => Math.hypot(...findVectors(course, state).L),
  },
};
