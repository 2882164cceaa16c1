// Formulas of what is drawn and tabled, in doubles: curves, bars, arrows, and constants of a motion.

/** @import { State } from "../physics/state.js" */
/** @import { Top } from "../physics/kernel.js" */
/**
 * Parts of the energy in J. E' is the sum of weight, precession and nutation; the spin keeps its
 * part until the next kick.
 * @typedef {{spin: number, weight: number, precession: number, nutation: number}} Energies
 */

/**
 * The torques about the line of nodes in the precessing frame, in N m; their total is Ix theta''.
 * @param {Top} top @param {number} theta @param {number} rate phi' @param {number} spin psi'
 */
export const findFrameTorques = ({ Ix, Iz, Mgl }, theta, rate, spin) => {
  const [cosine, sine] = [Math.cos(theta), Math.sin(theta)];
  const gravity = Mgl * sine;
  const coriolis = -Iz * spin * rate * sine;
  const centrifugal = (Ix - Iz) * (rate * rate) * sine * cosine;
  return { gravity, coriolis, centrifugal, total: gravity + coriolis + centrifugal };
};

/**
 * theta'' in rad/s^2.
 * @param {Top} top @param {number} theta @param {number} rate phi' @param {number} spin psi'
 */
export const findTiltAcceleration = (top, theta, rate, spin) =>
  findFrameTorques(top, theta, rate, spin).total / top.Ix;

/**
 * Energy, and the angular momentum about the axis and about the vertical.
 * @param {Top} top @param {State} state
 */
export const findConstants = ({ Ix, Iz, Mgl }, state) => {
  const [x, y, z] = state.omega;
  const [gx, gy, gz] = state.vertical;
  return {
    energy: (Ix * x * x + Ix * y * y + Iz * z * z) / 2 + Mgl * gz,
    L_z: Iz * z,
    "L_z'": Ix * x * gx + Ix * y * gy + Iz * z * gz,
  };
};

/** L in the world, in N m s. @param {Top} top @param {State} state */
export const findAngularMomentum = ({ Ix, Iz }, state) => {
  const [x, y, z] = state.omega;
  return state.toWorld([Ix * x, Ix * y, Iz * z]);
};

/**
 * The torque of a hand that holds phi, in the world, in N m: p_psi times the velocity of the end of the
 * axle (derivation, section 11).
 * @param {Top} top @param {State} state
 */
export const findClampTorque = ({ Iz }, state) => {
  const [x, y, z] = state.omega;
  return state.toWorld([Iz * z * y, -Iz * z * x, 0]);
};

/**
 * phi' where the axis of a motion has a tilt, from the state at another one: sin^2(theta) phi' changes by
 * p_psi/Ix times the change of height, which is a product.
 * @param {Top} top @param {State} state @param {number} theta not 0 or pi
 */
export const findPrecession = ({ Ix, Iz }, { omega, vertical, angles }, theta) => {
  const [[x, y, z], [gx, gy]] = [omega, vertical];
  const halves = [theta + angles.theta, theta - angles.theta].map((each) => Math.sin(each / 2));
  const sine = Math.sin(theta);
  return (x * gx + y * gy + (Iz / Ix) * z * 2 * halves[0] * halves[1]) / (sine * sine);
};

/** The sizes of the parts that add up to each of them. @param {Top} top @param {State} state */
export const findSizes = ({ Ix, Iz, Mgl }, state) => {
  const [x, y, z] = state.omega;
  const across = Ix * Math.hypot(x, y);
  return {
    energy: (across * Math.hypot(x, y) + Iz * z * z) / 2 + Math.abs(Mgl),
    L_z: Iz * Math.abs(z),
    "L_z'": Math.hypot(across, Iz * z),
  };
};

/** The least |psi'| at which the top sleeps upright; 0 if every one will do. @param {Top} top */
export const findCriticalSpin = ({ Ix, Iz, Mgl }) =>
  (2 * Math.sqrt(Ix) * Math.sqrt(Math.max(Mgl, 0))) / Iz;

const FLAT = 16 * Number.EPSILON; // of Ix, as in physics/body.py

/**
 * Refuse a mass that no body with these moments has: M r^2 <= Ix - Iz/2.
 * @param {Top} top @param {import("./course.js").Weighed} weighed
 */
export const demandMass = ({ Ix, Iz, Mgl }, { mass, gravity }) => {
  const lever = Mgl / gravity;
  const most = Ix - Iz / 2;
  if (mass === 0 || lever * (lever / mass) <= most + FLAT * Ix) return;
  const least = most > 0 ? (lever / most) * lever : Infinity;
  const condition = `at least ${least} kg for this top, Mgl^2/(gravity^2 (Ix - Iz/2))`;
  throw new RangeError(`mass must be ${condition}, got ${mass}`);
};

/**
 * The force of the pivot on a top on which only its weight acts, in N: its size, and its part along the
 * vertical. It is M (a + g), with the acceleration of the end of the arm by Euler's equations.
 * @param {Top} top @param {State} state @param {number} mass in kg @param {number} gravity in m/s^2
 */
export const findPivotForce = ({ Ix, Iz, Mgl }, state, mass, gravity) => {
  const [x, y, z] = state.omega;
  const [gx, gy, gz] = state.vertical;
  // Iz omega_z of each acceleration across the axis, and what the weight gives.
  const across = (/** @type {number} */ rate, /** @type {number} */ g) =>
    (Mgl / gravity) * ((Iz / Ix) * z * rate - (Mgl / Ix) * g) + mass * gravity * g;
  const along = mass * gravity * gz - (Mgl / gravity) * (x * x + y * y);
  const force = [across(x, gx), across(y, gy), along];
  const upward = force[0] * gx + force[1] * gy + force[2] * gz;
  return { size: Math.hypot(...force), upward };
};

/**
 * Energies of two states, what was gained from the first to the last, and the sizes of it.
 * @param {Top} top @param {State} first @param {State} last
 * @returns {{gained: Energies, first: Energies, last: Energies, sizes: Energies, momentum_size: number,
 *   height: number, mean_along: number, last_sine: number}}
 */
export const findExchange = (top, first, last) =>
  /** @type {any} */ (first.kernel.findExchange(top, first, last));

/** @param {Top} top @param {State} state */
export const findEnergies = (top, state) => findExchange(top, state, state).first;

/** @param {Energies} energies */
export const findRest = ({ weight, precession, nutation }) => weight + precession + nutation;

/**
 * The effective potential over theta, and the energy E' in it.
 * @param {Top} top @param {State} state
 */
export const findPotential = (top, state) => {
  const { L_z, "L_z'": vertical } = findConstants(top, state);
  const at = (/** @type {number} */ theta) => {
    // b - a u as (b - a) + a (1 - u): for an upright axis nothing is left of the difference.
    const half = Math.sin(theta / 2);
    const turning = (vertical - L_z) / top.Ix + (L_z / top.Ix) * (2 * half * half);
    const share = turning === 0 ? 0 : turning / Math.sin(theta);
    return (top.Ix * share * share) / 2 + top.Mgl * Math.cos(theta);
  };
  return { at, energy: findRest(findEnergies(top, state)) };
};

/** The same of an axis that is held in a vertical plane: that of the weight alone. @param {Top} top @param {State} state */
export const findHeldPotential = (top, state) => {
  const { weight, nutation } = findEnergies(top, state);
  const at = (/** @type {number} */ theta) => top.Mgl * Math.cos(theta);
  return { at, energy: weight + nutation };
};
