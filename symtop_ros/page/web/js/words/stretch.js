// Who gave energy and momentum in a stretch of a run, and who has it. The numbers are the kernel's; the
// record of their names is that of physics/ledger.py.

import { findConstants, findExchange, findRest } from "../physics/formulas.js";
import { NANO } from "../physics/course.js";
import { MILLI } from "./ledger.js";
import { phrase } from "./wording.js";

/** @import { Energies } from "../physics/formulas.js" */
/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Run, Moment } from "../run/run.js" */
/** What a cause gave: work in J, and to p_phi and p_psi in N m s. @typedef {{who: string, work: number, vertical: number, axial: number}} Given */
/** What became of a stretch. @typedef {{duration: number, gained: Energies, given: Given[], sizes: Energies, momentum: number}} Stretch */

const ROUNDING = 1e-12; // of the sizes at both ends; less is none
const HALVINGS = 60; // of half a nutation, in which a turning point is found
const SLIP = 0.25; // ns to which it is found: states are those of whole ones
/** @type {("weight" | "precession" | "nutation" | "spin")[]} */
const PARTS = ["weight", "precession", "nutation", "spin"];

/** Who else than gravity acts on a course. @param {Course} course */
const nameForces = ({ friction, torque }) => {
  const acting = [friction, torque].map((each) => each.some((one) => one !== 0));
  if (acting[0] && acting[1]) return "both";
  return acting[0] ? "friction" : "torque";
};

/** What the pushes of a course gave, up to so many of them. @type {WeakMap<Course, Given & {number: number}>} */
const counted = new WeakMap();
const NO_PUSHES = { who: "pushes", work: 0, vertical: 0, axial: 0, number: 0 };

/**
 * What the pushes of an event gave up to a time since it: only new ones are counted.
 * @param {Moment} event @param {number} passed ns
 */
const countPushes = ({ course, before }, passed) => {
  const impulse = course.pushes?.impulse;
  if (impulse === undefined || !before) return NO_PUSHES;
  let piece = course.pieceAt(passed);
  const { number } = piece;
  const found = counted.get(course) ?? NO_PUSHES;
  const known = number < found.number ? NO_PUSHES : found; // an earlier moment is shown
  let { work, vertical } = known;
  for (let left = number; left > known.number; left--) {
    const former = left > 1 ? course.findStateBefore(piece) : before;
    const found = findExchange(course.top, former, piece.course.start);
    work += impulse * found.mean_along;
    vertical += impulse * found.last_sine;
    if (left > 1) piece = course.pieceAt(piece.begin - 1);
  }
  const all = { ...NO_PUSHES, work, vertical, number };
  counted.set(course, all);
  return all;
};

/**
 * A stretch of a course from a state to another one; what friction or a torque gave is what the pushes
 * did not.
 * @param {Course} course @param {State} first @param {State} last @param {number} duration s
 * @param {Given} pushed what pushes gave in the stretch
 * @returns {Stretch}
 */
export const findStretch = (course, first, last, duration, pushed = NO_PUSHES) => {
  const { top, clamped, isDriven } = course;
  const { gained, sizes, height, momentum_size: momentum } = findExchange(top, first, last);
  const given = [pushed];
  const [before, after] = [first, last].map((each) => findConstants(top, each));
  if (clamped) {
    given.push({ who: "clamp", work: 0, vertical: before.L_z * height, axial: 0 });
  }
  if (isDriven) {
    given.push({
      who: nameForces(course),
      work: PARTS.reduce((sum, part) => sum + gained[part], 0) - pushed.work,
      vertical: after["L_z'"] - before["L_z'"] - pushed.vertical,
      axial: after.L_z - before.L_z,
    });
  }
  return { duration, gained, given, sizes, momentum };
};

/** @param {Stretch} stretch */
const listShares = ({ gained, given, sizes }) => {
  const rest = findRest(sizes);
  const shares = PARTS.filter(
    (part) => Math.abs(gained[part]) > ROUNDING * (part === "spin" ? sizes.spin : rest),
  ).map((who) => ({
    kind: gained[who] > 0 ? "got" : "gave",
    who: /** @type {string} */ (who),
    amount: MILLI * Math.abs(gained[who]),
  }));
  for (const { who, work } of given)
    if (Math.abs(work) > ROUNDING * rest)
      shares.push({ kind: work > 0 ? "gave" : "took", who, amount: MILLI * Math.abs(work) });
  const isGiver = (/** @type {{kind: string}} */ { kind }) => kind === "gave";
  return [...shares.filter(isGiver), ...shares.filter((each) => !isGiver(each))];
};

/** @param {Stretch} stretch */
const listGifts = ({ given, momentum }) =>
  given.flatMap(({ who, vertical, axial }) =>
    /** @type {[string, number][]} */ ([
      ["p_phi", vertical],
      ["p_psi", axial],
    ])
      .filter(([, amount]) => Math.abs(amount) > ROUNDING * momentum)
      .map(([name, amount]) => ({
        kind: amount > 0 ? "gave" : "took",
        who,
        amount: Math.abs(amount),
        name,
      })),
  );

/** The record of a stretch, as Python's `Exchange` has it. @param {Stretch} stretch */
export const nameExchange = (stretch) => {
  const [shares, gifts] = [listShares(stretch), listGifts(stretch)];
  return {
    kind: shares.length ? "energy" : "none",
    duration: stretch.duration,
    shares,
    momenta: { kind: gifts.length ? "changed" : "kept", gifts },
  };
};

/** The rate of cos(theta) in rad/s. @param {Course} course @param {number} passed ns, rounded */
const findRise = (course, passed) => {
  const { omega, vertical } = course.at(Math.round(passed));
  return vertical[0] * omega[1] - vertical[1] * omega[0];
};

/** The first turning point of a course, in ns since its start. @type {WeakMap<Course, number>} */
const firstTurns = new WeakMap();

/**
 * The rate of the height changes its sign at a turning point, and nowhere else in half a nutation. Next to
 * one its sign is rounding, so that the search begins where it is larger.
 * @param {Course} course @param {number} half of the nutation in ns
 */
const findFirstTurn = (course, half) => {
  const begins = [0, half / 2].map((time) => ({ time, rise: findRise(course, time) }));
  const { time, rise } = begins.reduce((a, b) => (Math.abs(b.rise) > Math.abs(a.rise) ? b : a));
  let [early, late] = [time, time + half];
  for (let k = 0; k < HALVINGS && late - early > SLIP; k++) {
    const middle = (early + late) / 2;
    if (findRise(course, middle) > 0 === rise > 0) early = middle;
    else late = middle;
  }
  return late < half - 1 ? late : Math.max(0, late - half);
};

/**
 * The last two turning points of a course up to a time since its start, in ns; null before the second.
 * @param {Course} course @param {number} passed ns
 * @returns {[number, number] | null}
 */
export const findLastTurns = (course, passed) => {
  const { isDriven, motion } = course;
  const half = (motion.rates.nutation_period * NANO) / 2;
  const [low, high] = motion.turning_angles;
  if (isDriven || !(low < high) || !(passed >= half)) return null; // also without a period
  const first = firstTurns.get(course) ?? findFirstTurn(course, half);
  firstTurns.set(course, first);
  const number = Math.floor((passed - first + 1) / half);
  return number < 1 ? null : [first + (number - 1) * half, first + number * half];
};

/**
 * What was exchanged since the last act, and between the last two turning points, in words.
 * @param {Run} run @param {number} time ns
 */
export const describeStretches = (run, time) => {
  const event = run.findEvent(time);
  const { course, before, time: began } = event;
  const pushed = countPushes(event, time - began);
  const first = pushed.number && before ? before : course.at(0);
  const act = findStretch(course, first, run.at(time), (time - began) / NANO, pushed);
  const { course: piece, begin } = course.pieceAt(time - began);
  const turns = findLastTurns(piece, time - began - begin);
  return {
    act: phrase("exchange", nameExchange(act)),
    turns: turns ? phrase("exchange", nameExchange(findBetween(piece, turns))) : "",
  };
};

/** @param {Course} course @param {[number, number]} turns ns since its start */
const findBetween = (course, [begin, end]) => {
  const [first, last] = [begin, end].map((each) => course.at(Math.round(each)));
  return findStretch(course, first, last, (end - begin) / NANO);
};
