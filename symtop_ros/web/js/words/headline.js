// What an event led to, as records: for the headline of the page, and for the reason below it.

import { judge, judgeKick } from "./verdict.js";

/** @typedef {import("../physics/course.js").Course} Course */
/** @typedef {import("../run/run.js").Moment} Moment */
/** @typedef {"friction" | "torque" | "both" | null} Forces what acts besides gravity */

/** @type {{[kind: string]: string}} */
const OPPOSITE = { higher: "falls", lower: "rises" };
/** @type {{[kind: string]: string}} */
const KINDS = { start: "start", change: "changed", torque: "released" };

/** @param {Course} course @returns {Forces} */
const findForces = ({ friction, torque }) => {
  const [rubs, turns] = [friction, torque].map((parts) => parts.some((each) => each !== 0));
  if (rubs && turns) return "both";
  if (rubs) return "friction";
  return turns ? "torque" : null;
};

/**
 * What a kick changed at the highest and the lowest point together.
 * @param {{kind: string}} highest
 * @param {{kind: string}} lowest
 */
const findSwing = (highest, lowest) => {
  const kinds = new Set([highest.kind, lowest.kind]);
  kinds.delete("unchanged");
  if (kinds.size === 2) return highest.kind === "higher" ? "wider" : "narrower";
  return [...kinds][0] ?? "same";
};

/**
 * The verdict on a kick, and what its headline adds: the direction in which the top moves at first,
 * where that is not the one in which it ends.
 * @param {Course} course
 * @param {import("../physics/state.js").State} before
 * @param {import("../physics/kernel.js").Hold | null} hold
 */
const findKick = (course, before, hold) => {
  const verdict = judgeKick(course, before, hold);
  const kind = findSwing(verdict.highest, verdict.lowest);
  const { direction } = verdict;
  return {
    outcome: verdict,
    swing: {
      kind,
      first: OPPOSITE[kind] === direction ? direction : null,
      most: Math.max(verdict.highest.amount, verdict.lowest.amount),
    },
  };
};

/**
 * The record of the headline, and that of its reason with the name of its template. Motions are
 * those under gravity alone; the headline says so where more acts.
 * @param {Moment} moment
 */
export const findOutcome = ({ kind, asked, course, before }) => {
  const { motion } = course.free;
  const forces = findForces(course);
  const subject = course.top.Mgl < 0 ? "axis" : "top";
  const { kind: moves, turning_angles } = motion;
  const headline = { subject, forces, motion: moves, turning_angles };
  if (kind === "kick" && before) {
    const { outcome, swing } = findKick(course, before, asked.hold ?? null);
    return { headline: { ...headline, ...swing }, name: "kick", outcome };
  }
  const verdict = judge(course);
  return {
    headline: { ...headline, kind: forces ? "driven" : (KINDS[kind] ?? "start") },
    name: forces ? "driven" : "start",
    outcome: { motion: moves, forces, verdict },
  };
};
