// Starts by names and numbers: of a scene, of a link, and by Euler's angles and rates.

import { NAMES } from "../physics/records.js";
import { readField } from "./reader.js";
import { State } from "../physics/state.js";
import { phrase } from "../words/wording.js";

/** @import { Vector, Top, Kernel } from "../physics/kernel.js" */
/**
 * The initial conditions of a scene are the `initial.*` parameters of a node; orientation x, y, z, w.
 * @typedef {{name: string, title: string, story: string, top: Vector, friction: number[],
 *   torque: Vector, initial: {[name: string]: any},
 *   weighed: import("../physics/course.js").Weighed}} SceneFile
 */
/**
 * The angles and rates of a scene are what a link that names it leaves open.
 * @typedef {{top: Top, friction: number[], torque: Vector, start: State, clamped?: boolean,
 *   weighed?: import("../physics/course.js").Weighed,
 *   initial?: {[name: string]: number}}} Beginning
 */

const ANGLES = ["phi", "theta", "psi", "phi_dot", "theta_dot", "psi_dot"];
const TOP_NAMES = /** @type {const} */ (["Ix", "Iz", "Mgl"]);
const VECTORS = ["orientation", "angular_velocity", "torque"];
/** @type {string[]} */
const FRICTION = NAMES.friction_kind;
const SINGLE = [...TOP_NAMES, ...FRICTION, ...ANGLES];
const PRECESSIONS = ["slow", "fast"];

export const OPENING = "hurry_slow"; // the scene with which the page opens

/** A number as a refusal or a request writes it. @param {number} x */
export const writeShort = (x) => String(Number(Number(x).toPrecision(4)));

/** @param {SceneFile[]} scenes @param {string} name */
export const findScene = (scenes, name) => {
  const scene = scenes.find((each) => each.name === name);
  if (scene) return scene;
  throw new RangeError(
    `scene must be one of ${scenes.map((each) => each.name).join(", ")}, got ${name}`,
  );
};

/** @param {Kernel} kernel @param {SceneFile} scene @returns {Beginning} */
export const readScene = (kernel, { top: [Ix, Iz, Mgl], friction, torque, initial, weighed }) => {
  const { precession, orientation, angular_velocity, clamped, ...numbers } = initial;
  const given = { top: { Ix, Iz, Mgl }, friction, torque, clamped, weighed };
  if (orientation.length) {
    const [x, y, z, w] = orientation;
    const omega = angular_velocity.length ? angular_velocity : [0, 0, 0];
    return { ...given, start: new State(kernel, [w, x, y, z], omega) };
  }
  const start = precession
    ? createStart(kernel, given.top, numbers, precession)
    : createStart(kernel, given.top, numbers);
  return { ...given, start, initial: numbers };
};

/**
 * A start by Euler's angles and rates; phi' may be that of a regular precession, slow or fast.
 * @param {Kernel} kernel
 * @param {Top} top
 * @param {{[name: string]: number}} numbers
 * @param {string} [precession]
 */
export const createStart = (kernel, top, numbers, precession) => {
  const { phi = 0, theta = 0, psi = 0, phi_dot = 0, theta_dot = 0, psi_dot = 0 } = numbers;
  if (!(theta >= 0 && theta <= Math.PI))
    throw new RangeError(`theta must be 0 to pi rad, got ${writeShort(theta)}`);
  const rates = { phi: phi_dot, theta: theta_dot, psi: psi_dot };
  if (precession !== undefined) {
    if (!PRECESSIONS.includes(precession))
      throw new RangeError(`precession must be slow or fast, got ${precession || "nothing"}`);
    const roots = kernel.findRegularRates(top, theta, psi_dot);
    if (!roots.length) throw new RangeError(phrase("refused.no_root"));
    rates.phi = precession === "fast" ? roots[roots.length - 1] : roots[0];
    rates.theta = 0;
  }
  return State.fromEuler(kernel, { phi, theta, psi }, rates);
};

/** Tilt and rates; on the vertical all of the spin is psi'. @param {State} state */
export const describeStart = (state) => {
  if (state.isVertical) return { theta: state.angles.theta, phi_dot: 0, psi_dot: state.omega[2] };
  const { phi, psi } = state.rates;
  return { theta: state.angles.theta, phi_dot: phi, psi_dot: psi };
};

/** @param {string} name @param {string | number} text of a link */
const toNumber = (name, text) => {
  const value = String(text).trim() ? Number(text) : NaN;
  if (Number.isFinite(value)) return value;
  throw new RangeError(`${name} must be a number, got ${text || "nothing"}`);
};

/** @param {[string, string | number]} pair of a link @returns {[string, number]} */
const readNumber = ([name, text]) => {
  if (SINGLE.includes(name)) return [name, toNumber(name, text)];
  const known = ["scene", "precession", "clamped", ...SINGLE, ...VECTORS];
  throw new RangeError(`name in a link must be one of ${known.join(", ")}, got ${name}`);
};

/**
 * The vectors of a link: numbers with commas between them.
 * @param {{[name: string]: string}} texts
 * @param {{[name: string]: import("./reader.js").Field}} fields of an event in run.json
 * @returns {{[name: string]: any}}
 */
const readVectors = (texts, fields) => {
  const names = VECTORS.filter((name) => Object.hasOwn(texts, name));
  const read = names.map((name) => {
    const parts = texts[name].split(",").map((part) => toNumber(name, part));
    return [name, readField(name, fields[name], parts)];
  });
  return Object.fromEntries(read);
};

/**
 * A start by its exact doubles, as the page writes it into a link.
 * @param {Kernel} kernel
 * @param {{[name: string]: any}} vectors
 * @param {boolean} isNamed by angles or rates as well
 */
const readState = (kernel, { orientation, angular_velocity }, isNamed) => {
  if (orientation && angular_velocity && !isNamed)
    return new State(kernel, orientation, angular_velocity);
  const names = `with angular_velocity, and without ${ANGLES.join(", ")} and precession`;
  throw new RangeError(`orientation in a link must be given ${names}`);
};

/**
 * The beginning that a link names: parameters of the top and initial conditions, and what it does
 * not name from a scene or another beginning.
 * @param {Kernel} kernel
 * @param {{[name: string]: string}} texts without the name of a scene
 * @param {Beginning} given
 * @param {{[name: string]: import("./reader.js").Field}} fields of an event in run.json
 * @returns {Beginning}
 */
export const readLink = (kernel, { precession, clamped: held, ...texts }, given, fields) => {
  const vectors = readVectors(texts, fields);
  const single = Object.entries(texts).filter(([name]) => !VECTORS.includes(name));
  const numbers = Object.fromEntries(single.map(readNumber));
  const top = { ...given.top };
  for (const each of TOP_NAMES) top[each] = numbers[each] ?? top[each];
  const friction = FRICTION.map((name, k) => numbers[name] ?? given.friction[k]);
  const torque = vectors.torque ?? given.torque;
  const isNamed = precession !== undefined || ANGLES.some((each) => each in numbers);
  let { start } = given;
  if (vectors.orientation || vectors.angular_velocity) start = readState(kernel, vectors, isNamed);
  else if (isNamed) {
    if (precession !== undefined) demandRegular(numbers);
    start = createStart(kernel, top, { ...given.initial, ...numbers }, precession);
  }
  const clamped = held === undefined ? given.clamped : readHeld(held);
  const isOwn = TOP_NAMES.every((each) => !(each in numbers));
  return { top, friction, torque, start, clamped, weighed: isOwn ? given.weighed : undefined };
};

/** Refuse rates next to a regular precession, which has its own. @param {{[name: string]: number}} numbers */
const demandRegular = (numbers) => {
  for (const name of ["phi_dot", "theta_dot"])
    if (numbers[name]) throw new RangeError(`precession must be given without ${name}, got both`);
};

/** @param {string} text of a link */
const readHeld = (text) => {
  if (text === "true" || text === "false") return text === "true";
  throw new RangeError(`clamped must be true or false, got ${text || "nothing"}`);
};

/** The fields of a link. A plus is that of 1e+20, and no space, as it would be in a form. @param {string} text */
export const splitLink = (text) =>
  Object.fromEntries(new URLSearchParams(text.replaceAll("+", "%2B")));

/** The link that starts a motion with the same doubles. @param {Beginning} beginning */
export const writeLink = ({ top, friction, torque, start, clamped }) => {
  const coefficients = Object.fromEntries(FRICTION.map((name, k) => [name, friction[k]]));
  const values = { ...top, ...coefficients, torque, ...(clamped ? { clamped } : {}) };
  const state = { orientation: start.given, angular_velocity: start.omega };
  return Object.entries({ ...values, ...state })
    .map(([name, value]) => `${name}=${value}`)
    .join("&");
};
