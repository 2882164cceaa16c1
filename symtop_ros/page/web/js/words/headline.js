// What an event led to, as records: for the headline of the page, and for the reason below it.

import { findPrecession } from "../physics/formulas.js";
import { findDecay } from "./decay.js";
import { judge, judgeClamp, judgeKick, nameSubject } from "./verdict.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Moment } from "../run/run.js" */
/** @typedef {"friction" | "torque" | "both" | null} Forces what acts besides gravity */

const SEEN = 5e-4; // rad; a tilt that differs by less looks the same, and reads the same with 3 decimals

/**
 * What a kick changed at one turning point: further than without it, less far, or no longer reached.
 * @typedef {"higher" | "less_high" | "no_rise" | "lower" | "less_far" | "no_fall"} Name
 * @typedef {{kind: Name, place: number, amount: number}} Change place 0 is the highest point, 1 the lowest
 */
/** The names of a place; its points lie further on if they are the first. @type {[Name, Name, Name][]} */
const NAMES = [
  ["higher", "less_high", "no_rise"],
  ["lower", "less_far", "no_fall"],
];
const WAYS = ["rises", "falls"]; // to the points of a place
// Of the largest phi': where the smallest one is less, loops are as narrow as a line (their width goes as
// its power of 3/2, a thousandth of that of the nutation), and no phi' is told from a stop.
const SEEN_RATE = 0.01;
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
 * What a kick changed at each turning point, as far as it is seen. A point that is reached from the tilt
 * of now is compared with the former one; one that is not, although the axis would have moved to it, is
 * named as lost.
 * @param {ReturnType<typeof judgeKick>} verdict @param {number} theta at the kick
 * @returns {Change[]}
 */
const listChanges = ({ highest, lowest, turning_angles }, theta) =>
  [highest, lowest].flatMap(({ kind, amount }, place) => {
    if (kind === "unchanged" || amount <= SEEN) return [];
    const [further, less, lost] = NAMES[place];
    const isReached = Math.abs(turning_angles[place] - theta) > SEEN;
    return [{ kind: kind === further ? further : isReached ? less : lost, place, amount }];
  });

/** @param {Change} change */
const isLost = ({ kind, place }) => kind === NAMES[place][2];

/**
 * The verdict on a kick, and what it changed.
 * @param {Course} course
 * @param {import("../physics/state.js").State} before
 * @param {import("../physics/kernel.js").Hold | null} hold
 */
const findKick = (course, before, hold) => {
  const outcome = judgeKick(course, before, hold);
  return { outcome, changes: listChanges(outcome, course.start.angles.theta) };
};

/**
 * The levels that a kick has moved, in rad: where each was and where it is. None where it moves none to
 * the eye, or friction or a torque acts.
 * @param {Moment} moment
 */
export const findLifts = ({ kind, asked, course, before }) => {
  if (kind !== "kick" || !before || findForces(course)) return [];
  const { outcome, changes } = findKick(course, before, asked.hold ?? null);
  const former = course.continueFree(before).motion.turning_angles;
  return changes.map(({ kind, place }) => ({
    ...{ kind, place, isFurther: kind === NAMES[place][0] },
    ...{ from: former[place], to: outcome.turning_angles[place] },
  }));
};

/**
 * The direction in which the top moves at first, where the headline names the other one alone, and it is
 * seen.
 * @param {ReturnType<typeof judgeKick>} verdict @param {Change[]} changes @param {number} theta
 */
const findFirst = ({ direction, turning_angles }, changes, theta) => {
  const place = WAYS.indexOf(direction);
  if (place < 0 || changes.some((each) => each.place === place)) return null;
  return Math.abs(turning_angles[place] - theta) > SEEN ? direction : null;
};

/**
 * What the headline says of a kick, and what of it the answer to the first question names.
 * @param {ReturnType<typeof findKick>} found @param {number} theta at the kick
 */
const describeKick = ({ outcome, changes }, theta) => {
  const isChanged = [outcome.highest, outcome.lowest].some(({ kind }) => kind !== "unchanged");
  const same = isChanged ? "hidden" : "same";
  if (!changes.length) return { kind: same, seen: [same] };
  const [lost, compared] = [true, false].map((is) => changes.filter((each) => isLost(each) === is));
  const ended = lost.length === 2 ? "neither" : (lost[0]?.kind ?? null);
  const seen = changes.map(({ kind }) => kind);
  if (!compared.length) return { kind: "ended", ended, seen };
  return { kind: "kicked", first: findFirst(outcome, changes, theta), compared, ended, seen };
};

/**
 * How a top moves, as far as it is seen: a tilt that stays, or loops and waves that are cusps to the eye.
 * @param {Course} free
 * @param {[number, number]} turning_angles
 * @param {string} reason of a verdict
 */
const findMoves = ({ motion: { kind }, top, start }, turning_angles, reason) => {
  if (kind === "regular") return reason === "no_precession" ? "still" : kind;
  if (!WAVES.includes(kind)) return kind;
  const [low, high] = turning_angles;
  if (low === high) return "hardly";
  const rates = turning_angles.map((theta) => Math.abs(findPrecession(top, start, theta)));
  const isSeen = Math.min(...rates) > SEEN_RATE * Math.max(...rates);
  return kind === "cusps" || isSeen ? kind : "nearly";
};

/**
 * The headline of what is no kick: by what acts, by the rest on the vertical, or by what was done.
 * @param {import("../run/run.js").Kind} kind @param {Forces} forces @param {{kind: string}} reason
 */
const findKind = (kind, forces, reason) => {
  if (forces) return "driven";
  return reason.kind === "unstable" ? "unstable" : (KINDS[kind] ?? "start");
};

/**
 * The record of the headline, that of its reason with the name of its template, and why the axis
 * moves so, null if nothing can be said. Motions are those under gravity alone, from the state of now; the headline says so where more acts.
 * @param {Moment} moment @param {Course} free the motion that would follow
 */
export const findOutcome = ({ kind, asked, course, before }, free) => {
  const forces = findForces(course);
  const subject = nameSubject(course.top);
  const headline = { subject, forces };
  if (kind === "kick" && before) {
    const found = findKick(course, before, asked.hold ?? null);
    const { outcome } = found;
    const kicked = { ...headline, ...describeKick(found, course.start.angles.theta) };
    // What the kick began says enough; what holds for the motion is said if there is no more.
    const { cause } = outcome;
    const because = cause.turn ? { ...cause, explanation: null } : cause;
    return { headline: kicked, name: "kick", outcome, because };
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
  const { kind: motion } = free.motion;
  return {
    headline: {
      ...headline,
      turning_angles,
      disturbed_to: verdict.reason.disturbed_to,
      kind: findKind(kind, forces, verdict.reason),
      motion: findMoves(free, turning_angles, verdict.reason.kind),
    },
    name: forces ? "driven" : "start",
    outcome: {
      motion,
      neglected: forces && { forces },
      verdict,
      clamp: null,
      decay: findDecay(course),
    },
    because: forces ? null : verdict.cause,
  };
};
