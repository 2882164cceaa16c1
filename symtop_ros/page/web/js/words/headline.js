// What an event led to, as records: for the headline of the page, and for the reason below it.

import { judge, judgeClamp, judgeKick } from "./verdict.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Moment } from "../run/run.js" */
/** @typedef {"friction" | "torque" | "both" | null} Forces what acts besides gravity */

const SEEN = 5e-4; // rad; a tilt that differs by less looks the same, and reads the same with 3 decimals

/** @type {{[kind: string]: string}} */
const OPPOSITE = { higher: "falls", lower: "rises" };
const WAVES = ["cusps", "looping", "unidirectional"];
/** @type {{[kind: string]: string}} */
const KINDS = { start: "start", change: "changed", torque: "released", unclamp: "let_go" };

/** @param {Course} course @returns {Forces} */
export const findForces = ({ friction, torque }) => {
  const [rubs, turns] = [friction, torque].map((parts) => parts.some((each) => each !== 0));
  if (rubs && turns) return "both";
  if (rubs) return "friction";
  return turns ? "torque" : null;
};

/**
 * What a kick changed at the highest and the lowest point together, as far as it is seen.
 * @param {import("./verdict.js").Lift} highest @param {import("./verdict.js").Lift} lowest
 */
const findSwing = (highest, lowest) => {
  const lifts = [highest, lowest].filter(({ kind }) => kind !== "unchanged");
  const kinds = new Set(lifts.filter(({ amount }) => amount > SEEN).map(({ kind }) => kind));
  if (kinds.size === 2) return highest.kind === "higher" ? "wider" : "narrower";
  return [...kinds][0] ?? (lifts.length ? "hidden" : "same");
};

/**
 * The level that a kick has moved, of the highest or of the lowest point, in rad: where it was and where
 * it is. Null where it moves none to the eye, or friction or a torque acts.
 * @param {Moment} moment
 */
export const findLift = ({ kind, asked, course, before }) => {
  if (kind !== "kick" || !before || findForces(course)) return null;
  const { outcome, swing } = findKick(course, before, asked.hold ?? null);
  if (swing.kind !== "higher" && swing.kind !== "lower") return null;
  const place = outcome.highest.amount < outcome.lowest.amount ? 1 : 0;
  const from = course.continueFree(before).motion.turning_angles[place];
  return { kind: swing.kind, place, from, to: outcome.turning_angles[place] };
};

/**
 * The verdict on a kick, and what its headline adds: the direction in which the top moves at first,
 * where that is not the one in which it ends, and it is seen.
 * @param {Course} course
 * @param {import("../physics/state.js").State} before
 * @param {import("../physics/kernel.js").Hold | null} hold
 */
const findKick = (course, before, hold) => {
  const verdict = judgeKick(course, before, hold);
  const kind = findSwing(verdict.highest, verdict.lowest);
  const { direction, turning_angles } = verdict;
  const { theta } = course.start.angles;
  const way = direction === "rises" ? theta - turning_angles[0] : turning_angles[1] - theta;
  return {
    outcome: verdict,
    swing: {
      kind,
      first: OPPOSITE[kind] === direction && way > SEEN ? direction : null,
      most: Math.max(verdict.highest.amount, verdict.lowest.amount),
    },
  };
};

/**
 * How a top moves, as far as it differs from a top that stays at its tilt.
 * @param {string} kind of the motion
 * @param {[number, number]} turning_angles
 * @param {string} reason of a verdict
 */
const findMoves = (kind, [low, high], reason) => {
  if (kind === "regular") return reason === "no_precession" ? "still" : kind;
  return WAVES.includes(kind) && low === high ? "hardly" : kind;
};

/**
 * The record of the headline, that of its reason with the name of its template, and why the axis
 * moves so, null if nothing can be said. Motions are those under gravity alone, from the state of now; the headline says so where more acts.
 * @param {Moment} moment @param {Course} free the motion that would follow
 */
export const findOutcome = ({ kind, asked, course, before }, free) => {
  const forces = findForces(course);
  const subject = course.top.Mgl < 0 ? "axis" : "top";
  const headline = { subject, forces };
  if (kind === "kick" && before) {
    const { outcome, swing } = findKick(course, before, asked.hold ?? null);
    // With friction or a torque the angles of the kick do not hold for long.
    const turning_angles = forces ? null : outcome.turning_angles;
    const kicked = { ...headline, turning_angles, ...swing };
    // What the kick began says enough; what holds for the motion is said if there is no more.
    const { cause } = outcome;
    const because = cause.turn ? { ...cause, explanation: null } : cause;
    return forces
      ? { headline: kicked, name: "after_kick", outcome: { verdict: outcome }, because }
      : { headline: kicked, name: "kick", outcome, because };
  }
  if (course.clamped) {
    const held = judgeClamp(course);
    return {
      headline: { ...held, kind: `held_${held.kind}` },
      name: "clamp",
      outcome: held,
      because: null,
    };
  }
  const verdict = judge(free);
  const { turning_angles } = verdict;
  const moves = free.motion.kind;
  return {
    headline: {
      ...headline,
      turning_angles,
      kind: forces ? "driven" : (KINDS[kind] ?? "start"),
      motion: findMoves(moves, turning_angles, verdict.reason.kind),
    },
    name: forces ? "driven" : "start",
    outcome: { motion: moves, neglected: forces && { forces }, verdict, clamp: null },
    because: forces ? null : verdict.cause,
  };
};
