// What a kick puts into the parts of the energy of a top.

import { findExchange, findRest } from "../physics/formulas.js";
import { findForces } from "./headline.js";

/** @import { Energies } from "../physics/formulas.js" */
/**
 * What has changed since before a kick, in mJ: just after it, and at the turning point that is
 * farther from there.
 * @typedef {{kick: Energies, far: Energies, point: "highest" | "lowest"}} Ledger
 */

export const MILLI = 1000;
export const ROUNDING = 1e-9; // of the largest change; less is drawn and told as none

/** @param {Energies} now @param {Energies} before @returns {Energies} in mJ */
const subtractEnergies = (now, before) => ({
  spin: MILLI * (now.spin - before.spin),
  weight: MILLI * (now.weight - before.weight),
  precession: MILLI * (now.precession - before.precession),
  nutation: MILLI * (now.nutation - before.nutation),
});

/**
 * The ledger of a kick, under gravity alone; null if the last event is none.
 * @param {import("../run/run.js").Moment} moment @returns {Ledger | null}
 */
export const findLedger = ({ kind, course, before }) => {
  if (kind !== "kick" || !before) return null;
  const { top, start, free } = course;
  const { gained, first, last: after } = findExchange(top, before, start);
  const [highest, lowest] = free.motion.turning_angles;
  const { theta } = start.angles;
  const isHighest = theta - highest > lowest - theta;
  const weight = top.Mgl * Math.cos(isHighest ? highest : lowest);
  const far = { ...after, weight, nutation: 0, precession: findRest(after) - weight };
  const none = { spin: 0, weight: 0, precession: 0, nutation: 0 };
  return {
    kick: subtractEnergies(gained, none),
    far: subtractEnergies(far, first),
    point: isHighest ? "highest" : "lowest",
  };
};

/** @param {number} change mJ @param {{weight: number, precession: number}} scale mJ */
export const nameGain = (change, { weight, precession }) => {
  const amount = Math.abs(change);
  if (amount <= ROUNDING * Math.max(Math.abs(weight), Math.abs(precession)))
    return { kind: "kept", amount };
  return { kind: change > 0 ? "gained" : "lost", amount };
};

/** The record of the ledger, in mJ. @param {import("../run/run.js").Moment} moment */
export const nameLedger = (moment) => {
  const ledger = findLedger(moment);
  if (!ledger) return { kind: "none" };
  const { kick, far, point } = ledger;
  const [weight, precession] = [far.weight, far.precession].map((each) => nameGain(each, far));
  const forces = findForces(moment.course);
  return { kind: "kick", forces, rest: findRest(kick), spin: kick.spin, weight, precession, point };
};
