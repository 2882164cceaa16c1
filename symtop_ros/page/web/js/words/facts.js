// What the page says and plots of a run: sentences, rates, roots, the potential.

import { NANO } from "../physics/course.js";
import { findForces, findOutcome } from "./headline.js";
import { listHistory } from "./history.js";
import { findHand, findPusher } from "./hand.js";
import { findLedger, nameLedger } from "./ledger.js";
import { describeOutlooks } from "./outlooks.js";
import { describePushes } from "./pushes.js";
import { findTurning, nameHalf } from "../physics/kinds.js";
import { nameSubject } from "./verdict.js";
import { describeStart, writeLink } from "../run/links.js";
import { findCriticalSpin, findHeldPotential, findPotential } from "../physics/formulas.js";
import { spread } from "../physics/spread.js";
import { phrase } from "./wording.js";
import { shorten } from "./quantities.js";

/** @import { Run, Moment } from "../run/run.js" */
/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Variant } from "./wording.js" */
/**
 * What holds after an act until the next one, what follows the motion, and how its top runs.
 * @typedef {ReturnType<typeof describe> & MotionFacts & {running: boolean, factor: number, recording: boolean}} Facts
 */

/** What friction and torques change. @typedef {ReturnType<typeof describeMotion>} MotionFacts */

const CURVE = 241; // points of a potential
const SEARCHED = 2001; // tilts among which the box of the potential is found
// Of the box, over the energy: in depths of the well, and of Mgl.
const ABOVE = 1;
const LEAST = 0.02;
const KICKS = ["kick", "push"];
const HELD = ["push", "torque"]; // which a button may still be giving
const TRACE_NUTATIONS = 12; // longest plot, in nutations

/**
 * The time in s that the plots show: one turn of the precession, or some nutations.
 * @param {Course} course
 */
export const chooseWindow = ({ motion }) => {
  const { mean_precession_rate: rate, nutation_period: period } = motion.rates;
  const turn = rate ? (2 * Math.PI) / Math.abs(rate) : Infinity;
  const shown = Math.min(Number.isNaN(turn) ? Infinity : turn, TRACE_NUTATIONS * period);
  return Number.isFinite(shown) ? Math.min(Math.max(shown, 0.05), 30) : 5;
};

/**
 * The box of the potential, its curve in it, and the curve before the last change.
 * @param {Course} free @param {Moment | null} change
 */
const describePotential = ({ top: body, start, motion, clamped }, change) => {
  const find = (/** @type {boolean} */ held) => (held ? findHeldPotential : findPotential);
  const potential = find(clamped)(body, start);
  const { before, last } = change ?? {};
  const former = before && last ? find(last.clamped)(last.top, before) : null;
  const angles = motion.turning_angles;
  const tilts = spread(1e-4, Math.PI - 1e-4, SEARCHED);
  const heights = tilts.map((tilt) => potential.at(tilt));
  const bottom = Math.min(...heights, potential.energy);
  const depth = potential.energy - bottom;
  const least = LEAST * Math.max(Math.abs(body.Mgl), Math.abs(depth), 1e-12);
  const top = potential.energy + Math.max(ABOVE * depth, least);
  const near = tilts.filter((_, k) => heights[k] <= top);
  const [low, high] = [
    Math.min(near[0] ?? angles[0], angles[0]),
    Math.max(near.at(-1) ?? angles[1], angles[1]),
  ];
  const margin = 0.04 * Math.max(high - low, 0.1);
  const [left, right] = [Math.max(0, low - margin), Math.min(Math.PI, high + margin)];
  const shown = [...spread(left, right, CURVE), ...angles].sort((a, b) => a - b);
  const sample = (/** @type {typeof potential} */ each) => ({
    theta: shown,
    height: shown.map((tilt) => Math.min(each.at(tilt), top + (top - bottom))),
  });
  return {
    left,
    right,
    // What was before a change is seen as well, unless it is far away.
    bottom:
      Math.max(Math.min(bottom, former?.energy ?? bottom), 2 * bottom - top) -
      0.08 * (top - bottom),
    top,
    energy: potential.energy,
    angles,
    ...sample(potential),
    before: former && sample(former),
  };
};

/**
 * What holds for a motion under gravity alone, which is said where more acts.
 * @param {Course} free @param {number} began s of the run @param {string} apart what else acts, in words
 */
const listRates = ({ kernel, motion, top, packed, clamped }, began, apart) => {
  const { nutation_period, mean_precession_rate } = motion.rates;
  /** @type {string[][]} */
  const rows = [];
  const add = (/** @type {string} */ name, /** @type {string} */ text) =>
    rows.push([phrase(`table.${name}`), `${text} ${apart}`.trim()]);
  add("motion", phrase(`motion.${motion.kind}`));
  if (Number.isFinite(nutation_period)) add("nutation_period", `${shorten(nutation_period)} s`);
  if (Number.isFinite(mean_precession_rate)) add("mean_phi_dot", writeWay(mean_precession_rate));
  if (Number.isFinite(1 / mean_precession_rate))
    add("turn", `${shorten((2 * Math.PI) / Math.abs(mean_precession_rate))} s`);
  const shows_at = began + (clamped ? Infinity : kernel.findDoubt(packed));
  if (Number.isFinite(shows_at)) add("rounding", phrase("table.rounding_from", { shows_at }));
  if (top.Mgl > 0)
    rows.push([phrase("table.critical_spin"), `${shorten(findCriticalSpin(top))} rad/s`]);
  return rows;
};

/** A mean rate of the precession, and which way round that is. @param {number} rate */
const writeWay = (rate) => {
  const kind = rate < 0 ? "clockwise" : "counterclockwise";
  return `${shorten(rate)} rad/s${rate ? `, ${phrase("way", { kind })}` : ""}`;
};

/** The last event that was not a torque of a button. @param {Run} run @param {number} time ns */
const findAnnounced = (run, time) => {
  const isPast = (/** @type {Moment} */ each) => each.kind !== "torque" && each.time <= time;
  return run.moments.findLast(isPast) ?? run.find(time);
};

/**
 * Why the axis moves so: what is said first, in one sentence, and what in numbers. What happens at first
 * comes behind what holds for the motion.
 * @template {{explanation: string | null, turn: string | null}} Cause
 * @param {Cause} cause @returns {[Cause, Cause]}
 */
const splitCause = (cause) => {
  const { explanation, turn } = cause;
  return [
    { ...cause, turn: explanation ? null : turn },
    { ...cause, turn: explanation ? turn : null },
  ];
};

/**
 * What follows the motion where friction or a torque acts: what gravity alone would make of the
 * state of now. Of a kick the sentences are those of the kick.
 * @param {Run} run
 * @param {number} time ns
 * @param {Course} free the motion that would follow under gravity alone
 */
export const describeMotion = (run, time, free) => {
  const announced = findAnnounced(run, time);
  const found = announced.kind === "push" ? describePushes(run, announced, time, free) : null;
  const moment = run.find(time);
  const { headline, name, outcome, because } = found ?? findOutcome(moment, free);
  const forces = findForces(moment.course);
  const apart = forces ? phrase("apart", { kind: forces }) : "";
  const say = (/** @type {Variant} */ variant) => ({
    headline: phrase("headline", headline, variant),
    because: because ? phrase("because", splitCause(because)[0], variant).trim() : "",
    measured: because ? phrase("in_numbers", splitCause(because)[1], variant).trim() : "",
    why: phrase(name, outcome, variant),
  });
  return {
    texts: { radians: say("radians"), degrees: say("degrees") },
    potential: describePotential(free, announced.kind === "start" ? null : announced),
    table: listRates(free, (forces ? time : moment.time) / NANO, apart),
    apart,
    turning: findTurning(free),
    seen: !forces && "seen" in headline ? headline.seen : null,
  };
};

const LEVEL = Math.PI / 2;
const NEAR = Math.PI / 36; // rad; a tilt so near to 90° is compared with half of it

/**
 * The slow regular rate at another tilt with the same psi', and by how many percent it differs; null if
 * there are not two at the tilt of now.
 * @param {import("../physics/kernel.js").Kernel} kernel @param {import("../physics/kernel.js").Top} top
 * @param {{theta: number, psi_dot: number, roots: number[]}} now
 */
const findElsewhere = (kernel, top, { theta, psi_dot, roots: [here] }) => {
  const tilt = Math.abs(theta - LEVEL) < NEAR ? LEVEL / 2 : LEVEL;
  const [rate] = kernel.findRegularRates(top, tilt, psi_dot);
  if (!here || !rate) return null;
  const change = 100 * (rate / here - 1);
  return {
    tilt: (tilt * 180) / Math.PI,
    rate,
    share: Math.abs(change),
    kind: change < 0 ? "less" : "more",
  };
};

/** Tilt, rates and regular rates of now. @typedef {ReturnType<typeof describeNow>} Now */
/** @param {Course} course @param {State} state */
export const describeNow = ({ kernel, top }, state) => {
  const { theta, phi_dot, psi_dot } = describeStart(state);
  const roots = kernel.findRegularRates(top, theta, psi_dot);
  const elsewhere = findElsewhere(kernel, top, { theta, psi_dot, roots });
  return { theta, phi_dot, psi_dot, roots, elsewhere };
};

/** The regular rates between which a push leads, which holds L_z. @param {Course} course */
const findPushRoots = ({ kernel, top, start }) =>
  kernel.findRegularRates(top, start.angles.theta, start.omega[2], "spin_momentum");

/** What holds after the last event until the next one. @param {Run} run @param {number} time ns */
export const describe = (run, time) => {
  const { course, kind, time: began } = run.find(time);
  const announced = findAnnounced(run, time);
  const first = run.findFirstNutation(time);
  const { roots, ...start } = describeNow(course, course.start);
  const pusher = findPusher(announced);
  return {
    histories: { radians: listHistory(run, "radians"), degrees: listHistory(run, "degrees") },
    top: course.parameters,
    disc: run.kernel.findDisc(course.top, course.weighed.gravity),
    start,
    roots,
    push_roots: findPushRoots(course),
    window: chooseWindow(course.free),
    since: run.findStart(time) / NANO,
    marks: run.moments.filter((each) => KICKS.includes(each.kind)).map((each) => each.time / NANO),
    acts: run.moments.filter((each) => each.kind !== "torque").map((each) => each.time / NANO),
    began: began / NANO,
    half: first && (first.begin + first.end) / (2 * NANO),
    link: writeLink(course),
    ledger: findLedger(announced),
    energies: phrase("ledger", nameLedger(announced)),
    pusher,
    hasHand: findHand(course, course.start, pusher) !== null,
    body: course.top,
    weighed: course.weighed,
    impulses: phrase("impulses", { kind: nameHalf(course), subject: nameSubject(course.top) }),
    outlooks: describeOutlooks(HELD.includes(kind) || course.clamped ? null : course),
    isHeld: course.clamped,
    isFresh: kind === "start",
  };
};
