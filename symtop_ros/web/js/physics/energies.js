// The parts of the energy of a top, and what a kick puts into them.

import { cosineAndSine } from "./elementary.js";

/** @typedef {import("./state.js").State} State */
/** @typedef {import("./precession.js").Top} Top */
/**
 * Parts of the energy in J. E' is the sum of weight, precession and nutation; the spin keeps its
 * part until the next kick.
 * @typedef {{spin: number, weight: number, precession: number, nutation: number}} Energies
 */
/**
 * What has changed since before a kick, in mJ: just after it, and at the turning point that is
 * farther from there.
 * @typedef {{kick: Energies, far: Energies, point: "highest" | "lowest"}} Ledger
 */

const MILLI = 1000;

/** @param {Energies} energies */
export const findRest = ({ weight, precession, nutation }) => weight + precession + nutation;

/**
 * @param {Top} top
 * @param {State} state
 * @returns {Energies}
 */
export const findEnergies = ({ Ix, Iz, Mgl }, state) => {
  const [x, y, z] = state.omega;
  const [gx, gy, gz] = state.vertical;
  const sine = Math.hypot(gx, gy);
  // Across the axis omega has two parts: about the line of nodes, and at right angles to it.
  const [along, across] = sine ? [(x * gx + y * gy) / sine, (x * gy - y * gx) / sine] : [x, y];
  return {
    spin: (Iz * z * z) / 2,
    weight: Mgl * gz,
    precession: (Ix * along * along) / 2,
    nutation: (Ix * across * across) / 2,
  };
};

/**
 * @param {Energies} now
 * @param {Energies} before
 * @returns {Energies} in mJ
 */
const subtractEnergies = (now, before) => ({
  spin: MILLI * (now.spin - before.spin),
  weight: MILLI * (now.weight - before.weight),
  precession: MILLI * (now.precession - before.precession),
  nutation: MILLI * (now.nutation - before.nutation),
});

/**
 * The ledger of a kick, under gravity alone; null if the last event is none.
 * @param {import("../run/run.js").Moment} moment
 * @returns {Ledger | null}
 */
export const findLedger = ({ kind, course, before }) => {
  if (kind !== "kick" || !before) return null;
  const { top, start, free } = course;
  const [first, after] = [findEnergies(top, before), findEnergies(top, start)];
  const [highest, lowest] = free.motion.turning_angles;
  const { theta } = start.angles;
  const isHighest = theta - highest > lowest - theta;
  const weight = top.Mgl * cosineAndSine(isHighest ? highest : lowest)[0];
  const far = { ...after, weight, nutation: 0, precession: findRest(after) - weight };
  return {
    kick: subtractEnergies(after, first),
    far: subtractEnergies(far, first),
    point: isHighest ? "highest" : "lowest",
  };
};
