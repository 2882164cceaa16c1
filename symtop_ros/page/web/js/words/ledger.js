// What a kick puts into the parts of the energy of a top.

import { findExchange, findRest } from "../physics/formulas.js";
import { findForces } from "./headline.js";

/** @import { Energies } from "../physics/formulas.js" */
/**
 * What has changed since before a kick, in mJ: just after it, and at the turning point that is
 * farther from there; whether the weight is highest or lowest there, which is what has that energy.
 * @typedef {{kick: Energies, far: Energies, point: "highest" | "lowest"}} Ledger
 */

export const MILLI = 1000;
export const ROUNDING = 1e-9; // of the largest change; less is drawn and told as none

/** @param {Energies} energies in J @returns {Energies} in mJ */
const toMilli = ({ spin, weight, precession, nutation }) => ({
  spin: MILLI * spin,
  weight: MILLI * weight,
  precession: MILLI * precession,
  nutation: MILLI * nutation,
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
  // At a turning point nothing nutates: what the weight has not, the precession has.
  const far = {
    spin: gained.spin,
    weight: weight - first.weight,
    precession: findRest(after) - weight - first.precession,
    nutation: -first.nutation,
  };
  return {
    kick: toMilli(gained),
    far: toMilli(far),
    // If Mgl < 0 the weight is lowest where the axis is highest.
    point: isHighest === top.Mgl >= 0 ? "highest" : "lowest",
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
