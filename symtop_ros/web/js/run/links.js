// Starts by names and numbers: of a scene, of a link, and by Euler's angles and rates.

import { findRegularRates } from "../physics/precession.js";
import { State } from "../physics/state.js";

/** @typedef {import("../physics/state.js").Vector} Vector */
/** @typedef {import("../physics/precession.js").Top} Top */
/**
 * @typedef {{name: string, title: string, story: string, top: Vector, friction: [number, number],
 *   torque: Vector, orientation: import("../physics/state.js").Quaternion, angular_velocity: Vector,
 *   initial: {[name: string]: number}}} SceneFile
 */
/**
 * The angles and rates of a scene are what a link that names it leaves open.
 * @typedef {{top: Top, friction: [number, number], start: State,
 *   initial?: {[name: string]: number}}} Beginning
 */

const ANGLES = ["phi", "theta", "psi", "phi_dot", "theta_dot", "psi_dot"];
const TOP_NAMES = /** @type {const} */ (["Ix", "Iz", "Mgl"]);
const NAMES = [...TOP_NAMES, "axial", "transverse", ...ANGLES];

/**
 * A number as a refusal or a request writes it.
 * @param {number} x
 */
export const writeShort = (x) => String(Number(Number(x).toPrecision(4)));

/**
 * @param {SceneFile[]} scenes
 * @param {string} name
 */
export const findScene = (scenes, name) => {
  const scene = scenes.find((each) => each.name === name);
  if (scene) return scene;
  throw new RangeError(
    `scene must be one of ${scenes.map((each) => each.name).join(", ")}, got ${name}`,
  );
};

/** @param {SceneFile} scene @returns {Beginning} */
export const readScene = ({
  top: [Ix, Iz, Mgl],
  friction,
  orientation,
  angular_velocity,
  initial,
}) => ({
  top: { Ix, Iz, Mgl },
  friction,
  start: new State(orientation, angular_velocity),
  initial,
});

/**
 * A start by Euler's angles and rates; phi' may be that of a regular precession, slow or fast.
 * @param {Top} top
 * @param {{[name: string]: number}} numbers
 * @param {string} [precession]
 */
export const createStart = (top, numbers, precession) => {
  const { phi = 0, theta = 0, psi = 0, phi_dot = 0, theta_dot = 0, psi_dot = 0 } = numbers;
  if (!(theta >= 0 && theta <= Math.PI))
    throw new RangeError(`theta must be 0 to pi rad, got ${writeShort(theta)}`);
  let rate = phi_dot;
  if (precession) {
    const roots = findRegularRates(top, theta, psi_dot);
    if (!roots.length) throw new RangeError("spin must be such that a regular precession exists");
    rate = precession === "fast" ? roots[roots.length - 1] : roots[0];
  }
  return State.fromEuler({ phi, theta, psi }, { phi: rate, theta: theta_dot, psi: psi_dot });
};

/** Tilt and rates; on the vertical all of the spin is psi'. @param {State} state */
export const describeStart = (state) => {
  if (state.isVertical) return { theta: state.angles.theta, phi_dot: 0, psi_dot: state.omega[2] };
  const round = (/** @type {number} */ x) => Math.round(x * 1e6) / 1e6;
  const { phi, psi } = state.rates;
  return { theta: state.angles.theta, phi_dot: round(phi), psi_dot: round(psi) };
};

/** @param {[string, string | number]} pair of a link @returns {[string, number]} */
const readNumber = ([name, text]) => {
  if (!NAMES.includes(name)) {
    throw new RangeError(
      `name in a link must be one of scene, precession, ${NAMES.join(", ")}, got ${name}`,
    );
  }
  const value = String(text).trim() ? Number(text) : NaN;
  if (!Number.isFinite(value))
    throw new RangeError(`${name} must be a number, got ${text || "nothing"}`);
  return [name, value];
};

/**
 * The beginning that a link names: parameters of the top and initial conditions, and what it does
 * not name from a scene or from the present motion.
 * @param {{[name: string]: string}} texts without the name of a scene
 * @param {Beginning} given
 * @returns {Beginning}
 */
export const readLink = ({ precession, ...texts }, given) => {
  const numbers = Object.fromEntries(Object.entries(texts).map(readNumber));
  const top = { ...given.top };
  for (const each of TOP_NAMES) top[each] = numbers[each] ?? top[each];
  /** @type {[number, number]} */
  const friction = [numbers.axial ?? given.friction[0], numbers.transverse ?? given.friction[1]];
  const isStart =
    precession !== undefined || Object.keys(numbers).some((each) => ANGLES.includes(each));
  const start = isStart
    ? createStart(top, { ...given.initial, ...numbers }, precession)
    : given.start;
  return { top, friction, start };
};
