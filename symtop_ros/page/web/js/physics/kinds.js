// Which kind of motion follows from a start with theta' = 0: decided by algebra, over psi' and phi'.
//
// phi' = (p_phi - p_psi u)/(Ix (1 - u^2)) vanishes at u = cos(theta) = p_phi/p_psi only, and the axis
// gets there if the height there costs less than E'.

import { findPrecession } from "./formulas.js";

/** @import { Top } from "../physics/kernel.js" */
/** @import { Course } from "./course.js" */
/**
 * Tilt, rates and regular rates where theta' = 0.
 * @typedef {{theta: number, phi_dot: number, psi_dot: number, roots: number[]}} Turning
 */

const TWICE = 2; // Mgl/p_psi: phi' of the second cusp
const STILL = 1e-7; // rad; from a turning point, where a fall or a rise begins
const AT_REST = 1e-9; // of omega: theta' that is smaller is none

/**
 * Whether phi' reverses: the motion makes loops.
 * @param {Top} top @param {number} theta @param {number} phiDot @param {number} psiDot
 */
export const makesLoops = ({ Ix, Iz, Mgl }, theta, phiDot, psiDot) => {
  const [u, sine] = [Math.cos(theta), Math.sin(theta)];
  const axial = Iz * (psiDot + phiDot * u);
  const vertical = Ix * phiDot * sine * sine + axial * u;
  // Both sides times p_psi^2, so that no spin is no exception.
  const reaches = (phiDot * axial - TWICE * Mgl) * phiDot * axial > 0;
  return Math.abs(vertical) < Math.abs(axial) && reaches;
};

/**
 * psi' of the boundaries between kinds, over phi': cusps, regular precession, and the two through
 * the vertical; NaN where there is none.
 * @param {Top} top
 * @param {number} theta
 * @param {number} phiDot not 0
 * @returns {{cusps: number, regular: number, upper: number, lower: number}}
 */
export const findBoundaries = ({ Ix, Iz, Mgl }, theta, phiDot) => {
  const [u, sine] = [Math.cos(theta), Math.sin(theta)];
  const turned = phiDot * u;
  const axial = (TWICE * Mgl) / phiDot;
  // Where phi' would vanish beyond the vertical there is no cusp.
  const isReached = Math.abs(Ix * phiDot * sine * sine + axial * u) < Math.abs(axial);
  return {
    cusps: isReached ? axial / Iz - turned : NaN,
    regular: ((Ix - Iz) * turned * phiDot + Mgl) / (Iz * phiDot),
    upper: ((Ix * (1 + u)) / Iz) * phiDot - turned,
    lower: ((-Ix * (1 - u)) / Iz) * phiDot - turned,
  };
};

/**
 * Tilt, rates and regular rates of a motion where theta' = 0: at its start, or at the turning point next to it.
 * Null where this is on the vertical, and where a hand holds the precession.
 * @param {Course} course @returns {Turning | null}
 */
export const findTurning = ({ kernel, top, start, free, clamped }) => {
  if (clamped) return null;
  const { theta: tilt } = start.angles;
  const { rates } = start;
  const isAtRest = Math.abs(rates.theta) <= AT_REST * Math.max(...start.omega.map(Math.abs));
  const [low, high] = free.motion.turning_angles;
  const theta = isAtRest ? tilt : tilt - low < high - tilt ? low : high;
  const [u, sine] = [Math.cos(theta), Math.sin(theta)];
  if (sine < 1e-6) return null;
  const phi_dot = isAtRest ? rates.phi : findPrecession(top, start, theta);
  const psi_dot = isAtRest ? rates.psi : start.omega[2] - phi_dot * u;
  return { theta, phi_dot, psi_dot, roots: kernel.findRegularRates(top, theta, psi_dot) };
};

/** Whether the half nutation from a start is a fall of the axis, a rise, or some of both. @param {Course} course */
export const nameHalf = ({ start, motion, isDriven }) => {
  const [least, most] = motion.turning_angles;
  if (isDriven || most - least <= STILL) return "half";
  const { theta } = start.angles;
  if (most - theta <= STILL) return "rise";
  return theta - least <= STILL ? "fall" : "half";
};
