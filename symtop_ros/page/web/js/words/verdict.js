// The kernel's verdicts as records for the templates, with null for what is undefined.

/** @import { Found, Hold, Direction } from "../physics/kernel.js" */
/** @import { Course } from "../physics/course.js" */
/** @typedef {{kind: string, amount: number}} Lift */

const ON_THE_VERTICAL = ["undefined", "stable", "unstable"];

/** What a sentence is about: below its pivot a weight rises where its axis falls. @param {{Mgl: number}} top */
export const nameSubject = ({ Mgl }) => (Mgl < 0 ? "axis" : "top");

/** @param {number[]} rates */
const keepDefined = (rates) => rates.filter((rate) => !Number.isNaN(rate));

/** Why Perry's rule holds, fails or says nothing. @param {Found} verdict @param {Hold} held */
const readReason = (
  { subject, disturbed_to: reach, reason: { kind, rule, place, ...found } },
  held,
) => {
  const disturbed_to = Number.isNaN(reach) ? null : reach;
  if (!ON_THE_VERTICAL.includes(kind)) {
    const regular_rates = keepDefined(place.regular_rates);
    const among = { ...place, regular_rates, held };
    return { kind, rule, subject, ...found, place: among, disturbed_to };
  }
  const numbers = { before: null, after: null, theta_ddot_without: null, theta_ddot: null };
  const nothing = { ...numbers, effect: null };
  return { kind, rule, subject, ...nothing, place: null, disturbed_to };
};

/** @param {Found} average */
const readAverage = ({ is_fast, precession_period, ...average }) => {
  if (!Number.isFinite(average.turns)) return null;
  const turn = Number.isFinite(precession_period) ? precession_period : null;
  return { ...average, precession_period: turn, speed: is_fast ? "fast" : "slow" };
};

/** The means with a kick, compared with none; null where they are undefined. @param {Found} verdict */
const readMeans = ({ subject, means: { rates, cosines, ...said } }) => {
  if (Number.isNaN(cosines[0])) return null;
  return { ...said, rates: rates.some(Number.isNaN) ? null : rates, cosines, subject };
};

/** Why the axis moves as it does; without numbers for a driven motion. @param {Found} cause @param {string} subject */
const readCause = ({ torque_share, rate_about_momentum: rate, ...cause }, subject) => {
  const { explanation, turn, pace, constant, ...angles } = cause;
  const kept = Object.entries(angles).map(([name, found]) => [
    name,
    Number.isNaN(rate) ? null : found,
  ]);
  const share = Number.isNaN(torque_share) ? null : torque_share;
  const numbers = { torque_share: share, rate_about_momentum: Number.isNaN(rate) ? null : rate };
  const said = { explanation, turn, pace, constant, subject };
  return { ...said, ...numbers, ...Object.fromEntries(kept) };
};

/**
 * The verdict on a start under gravity alone, and what Perry's rule says if it is hurried: by a push on
 * the axle, as that of the page's button, unless something else is held.
 * @param {Course} course @param {number} factor @param {Hold} hold
 */
export const judge = ({ kernel, free }, factor = 1.4, hold = "spin_momentum") => {
  const found = kernel.judge(free.packed, factor, hold);
  const reason = readReason(found, hold);
  return {
    subject: found.subject,
    direction: found.direction,
    turning_angles: found.turning_angles,
    regular_rates: reason.place?.regular_rates ?? [],
    rule_holds: reason.rule && reason.rule === "holds",
    reason,
    average: readAverage(found.average),
    means: readMeans(found),
    cause: readCause(found.cause, found.subject),
  };
};

/** What follows while a hand holds the precession of a course. @param {Course} course @returns {Found} */
export const judgeClamp = ({ kernel, packed }) => {
  const { lowest_in, ...held } = kernel.judgeClamp(packed);
  return { ...held, lowest_in: Number.isNaN(lowest_in) ? null : lowest_in };
};

/**
 * The verdict on the kick with which a course begins.
 * @param {Course} course
 * @param {import("../physics/state.js").State} before
 * @param {Hold | null} hold null for an angular impulse
 */
export const judgeKick = (course, before, hold) => {
  const { kernel, packed, isDriven } = course;
  const found = kernel.judgeKick(course.continueFree(before).packed, packed, hold);
  const { factor, disturbed_to: _to, reason: _, average, means: _means, cause, ...others } = found;
  // A push along the precession holds the spin momentum; after any other angular impulse the kernel
  // finds the rates at the spin rate that it left.
  const isPush = found.reason.kind !== "angular_impulse";
  const reason = readReason(found, hold ?? (isPush ? "spin_momentum" : "spin_rate"));
  return {
    ...{
      direction: /** @type {Direction} */ (found.direction),
      turning_angles: /** @type {[number, number]} */ (found.turning_angles),
      highest: /** @type {Lift} */ (found.highest),
      lowest: /** @type {Lift} */ (found.lowest),
    },
    ...others,
    axis: before.isVertical ? "vertical" : "tilted",
    hold,
    factor: Number.isNaN(factor) ? null : factor,
    before: reason.before,
    after: reason.after,
    driven: isDriven,
    reason,
    average: readAverage(average),
    means: readMeans(found),
    cause: readCause(cause, others.subject),
  };
};
