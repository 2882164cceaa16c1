// Twin of physics/rule/verdict.py and kick_effect.py: what a start or a kick leads to, as records.

import { findLength } from "./elementary.js";
import { nameSubject, PrecessionChange, TiltAcceleration } from "./rule.js";
import { START_ROUNDING } from "./precession.js";

/** @typedef {import("./kernel.js").Motion} Motion */
/** @typedef {import("./state.js").State} State */
/** @typedef {import("./precession.js").Top} Top */
/** @typedef {import("./kicks.js").Hold} Hold */
/** @typedef {import("./rule.js").Direction} Direction */
/**
 * Why Perry's rule holds, fails or says nothing.
 * @typedef {{kind: string, rule: string | null, subject: string, before: number | null,
 *   after: number | null, theta_ddot_without: number | null, theta_ddot: number | null,
 *   place: object | null}} Reason
 */
/**
 * A motion and what it starts from; `free` is the same under gravity alone.
 * @typedef {{top: Top, start: State, motion: Motion, isDriven: boolean}} Course
 */

const EPS = 2 ** -52;
const SAME_ANGLE = 1e-7; // rad

/**
 * Whether a resting vertical axis is stable.
 * @param {Top} top
 * @param {State} state
 */
const isSleepingStable = ({ Ix, Iz, Mgl }, state) => {
  const weight = state.vertical[2] > 0 ? Mgl : -Mgl;
  if (weight <= 0) return true;
  const least = 2 * Math.sqrt(Ix) * Math.sqrt(weight);
  return Math.abs(Iz * state.omega[2]) >= (1 - 8 * EPS) * least;
};

/**
 * @param {Top} top
 * @param {State} state
 */
const classifyVertical = (top, state) => {
  if (state.omega[0] || state.omega[1]) return "undefined";
  return isSleepingStable(top, state) ? "stable" : "unstable";
};

/**
 * @param {Top} top
 * @param {State} state
 * @returns {Reason}
 */
const explainVertical = (top, state) => ({
  kind: classifyVertical(top, state),
  rule: null,
  subject: nameSubject(top),
  before: null,
  after: null,
  theta_ddot_without: null,
  theta_ddot: null,
  place: null,
});

/**
 * @param {Top} top
 * @param {State} state
 * @returns {Direction}
 */
const findDirection = (top, state) => {
  if (state.isVertical) {
    if (findLength(state.omega[0], state.omega[1]) === 0) return "stays";
    return state.vertical[2] > 0 ? "falls" : "rises";
  }
  let change = state.rates.theta;
  if (Math.abs(change) <= START_ROUNDING * Math.max(...state.omega.map(Math.abs))) {
    change = new TiltAcceleration(top, state, "spin_rate").at(state.rates.phi);
  }
  if (change === 0) return "stays";
  return change < 0 ? "rises" : "falls";
};

/** @param {Course} course */
const findAverage = ({ top, start, motion }) => {
  const {
    precession_per_nutation: turns,
    mean_precession_rate: rate,
    spin_reverses,
  } = motion.rates;
  if (!Number.isFinite(turns)) return null;
  const spin = start.omega[2];
  const least = (2 * Math.sqrt(top.Ix) * Math.sqrt(Math.abs(top.Mgl))) / top.Iz;
  const speed = top.Mgl && Math.abs(spin) > least ? "fast" : "slow";
  const fast_top_rate = top.Iz * spin ? top.Mgl / (top.Iz * spin) : NaN;
  return { rate, turns, speed, fast_top_rate, spin_reverses };
};

/**
 * The verdict on a state: what follows, and what Perry's rule would say if it were hurried.
 * @param {Course} course under gravity alone
 * @param {number} factor
 * @param {Hold} hold
 */
export const judge = (course, factor = 1.4, hold = "spin_rate") => {
  const { top, start, motion } = course;
  const tilt = start.isVertical ? null : new TiltAcceleration(top, start, hold);
  let reason = explainVertical(top, start);
  if (tilt) {
    const [rate] = start.exactRates;
    reason = new PrecessionChange(top, tilt, rate, factor * rate, factor).explain(false);
  }
  return {
    subject: nameSubject(top),
    direction: findDirection(top, start),
    turning_angles: motion.turning_angles,
    regular_rates: tilt ? tilt.quadratic.roots : [],
    rule_holds: reason.rule === null ? null : reason.rule === "holds",
    reason,
    average: findAverage(course),
  };
};

/**
 * @param {number} was
 * @param {number} now
 */
const compare = (was, now) => {
  const change = Math.abs(was - now) > SAME_ANGLE ? was - now : 0;
  const kind = change ? (change > 0 ? "higher" : "lower") : "unchanged";
  return { kind, amount: Math.abs(change) };
};

/**
 * Facts that contradict what the rule says, or null.
 * @param {{rule: string | null, subject: string}} reason
 * @param {Direction | null} expected
 * @param {Direction} direction
 * @param {{kind: string}} highest
 * @param {{kind: string}} lowest
 */
const findContradiction = ({ rule, subject }, expected, direction, highest, lowest) => {
  if (expected === null || rule === null) return null;
  const rises = expected === "rises";
  const facts = [];
  if (direction !== expected && direction !== "stays") facts.push(rises ? "falls" : "rises");
  const opposite = rises ? "lower" : "higher";
  if (highest.kind === opposite) facts.push(`highest_${opposite}`);
  if (lowest.kind === opposite) facts.push(`lowest_${opposite}`);
  return facts.length ? { rule, subject, facts } : null;
};

/**
 * The verdict on a kick. `anglesBefore` are the turning angles without it.
 * @param {Course} course after the kick
 * @param {State} before
 * @param {number[]} anglesBefore
 * @param {Hold | null} hold null for an angular impulse
 */
export const judgeKick = (course, before, anglesBefore, hold) => {
  const { top, start, motion, isDriven } = course;
  const kick = before.isVertical ? null : PrecessionChange.between(top, before, start, hold);
  const reason = kick ? kick.explain(true) : explainVertical(top, start);
  const direction = findDirection(top, start);
  const angles = motion.turning_angles;
  const [highest, lowest] = angles.map((now, k) => compare(anglesBefore[k], now));
  return {
    axis: kick ? "tilted" : "vertical",
    hold,
    factor: kick ? kick.factor : null,
    before: reason.before,
    after: reason.after,
    motion: motion.kind,
    subject: nameSubject(top),
    direction,
    turning_angles: angles,
    driven: isDriven,
    reason,
    highest,
    lowest,
    contradiction: findContradiction(
      reason,
      kick ? kick.expected : null,
      direction,
      highest,
      lowest,
    ),
    average: isDriven ? null : findAverage(course),
  };
};
