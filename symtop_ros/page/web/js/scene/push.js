// What a kick did, for the scene: where the axle was pushed, and the bracket between the height that the
// top would have and the one that it reaches.

import { spread } from "../physics/spread.js";
import { NANO } from "../physics/course.js";
import { findLifts } from "../words/headline.js";
import { findPoint, listPieces } from "./curves.js";
import { cross, findSize, normalize, subtract } from "./matrices.js";

/** @import { Vector } from "../physics/kernel.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Moment } from "../run/run.js" */
/** @typedef {ReturnType<typeof findLifts>[number]} Lift */
/**
 * The angular impulse of a kick in N m s, by which it turned the axle round and twisted it, and the arc of
 * the twist about the axle. @typedef {{across: number, along: number, arc: Vector[]}} Twist
 */
/**
 * The end of the axle at a kick, and the direction in which it was pushed, if it was; its twist, if a push
 * was not all; the times in ns of the kick and of the end of its first nutation; the levels that it moved.
 * @typedef {{tip: Vector, way: Vector | null, twist: Twist | null, begin: number, end: number,
 *   lifts: Lift[]}} Push
 */

const RADIUS = 1.02; // of the lines of the levels
// Of these lines along the two circles: where they begin, behind the ball, and end. The bracket is at their end.
const LINES = { begin: 0.1, end: 0.34, bracket: 0.3 };
const STEEP = 0.3; // the sine of a tilt at whose circle the lines are no longer
const ROUNDING = 1e-9; // of a velocity: less is no push
// The arc of a twist: its place along the axle, its radius, and its length in rad.
const ARC = { place: 0.84, radius: 0.17, length: 5 };

/** @param {Moment} moment @returns {Push | null} */
export const findPush = (moment) => {
  const { kind, time, course, before } = moment;
  if ((kind !== "kick" && kind !== "push") || !before) return null;
  const { start, free } = course;
  const tip = start.toWorld([0, 0, 1]);
  const change = cross(start.toWorld(subtract(start.omega, before.omega)), tip);
  const isPushed = findSize(change) > ROUNDING * findSize(start.omega);
  const end = time + free.motion.nutation_period * NANO;
  const way = isPushed ? normalize(change) : null;
  return { tip, way, twist: findTwist(moment), begin: time, end, lifts: findLifts(moment) };
};

/**
 * The twist of a kick that held psi': a push alone holds L_z, and leaves psi' another. Null if the kick was
 * a push, or on a level axle, where both are the same.
 * @param {Moment} moment @returns {Twist | null}
 */
const findTwist = ({ asked, course, before }) => {
  if (asked.hold !== "spin_rate" || !before) return null;
  const { start, top } = course;
  const [x, y, z] = subtract(start.omega, before.omega);
  if (Math.abs(z) <= ROUNDING * findSize(start.omega)) return null;
  const turns = spread(0, Math.sign(z) * ARC.length, 25);
  const arc = turns.map((angle) => {
    const [right, up] = [ARC.radius * Math.cos(angle), ARC.radius * Math.sin(angle)];
    return start.toWorld([right, up, ARC.place]);
  });
  return { across: top.Ix * Math.hypot(x, y), along: Math.abs(top.Iz * z), arc };
};

/**
 * The levels that have been reached since a kick, and by how much they have moved. What lies less far
 * than without the kick is known when the first nutation has ended.
 * @param {Push} push @param {number} time ns @param {State[]} states since the kick
 */
export const listReached = ({ lifts, end }, time, states) => {
  const tilts = states.map((each) => each.angles.theta);
  return lifts.flatMap(({ kind, place, isFurther, from, to }) => {
    if (time >= end) return [{ kind, from, to, amount: Math.abs(to - from) }];
    const reached = place ? Math.max(...tilts) : Math.min(...tilts);
    const amount = place ? reached - from : from - reached;
    return isFurther && amount > 0 ? [{ kind, from, to: reached, amount }] : [];
  });
};

/**
 * The points of a dimension: lines at two levels, on the side to which the axle goes, and the bracket
 * between them, with its middle.
 * @param {{from: number, to: number}} levels @param {State} state
 */
export const listBracket = ({ from, to }, { angles: { phi }, rates }) => {
  const side = rates.phi < 0 ? -1 : 1;
  const place = (/** @type {number} */ theta, /** @type {number} */ part) =>
    findPoint(theta, phi + (side * part) / Math.max(Math.sin(theta), STEEP), RADIUS);
  const level = (/** @type {number} */ theta) =>
    listPieces(spread(LINES.begin, LINES.end, 13).map((part) => place(theta, part)));
  const bracket = spread(from, to, 13).map((theta) => place(theta, LINES.bracket));
  return {
    pieces: [...level(from), ...level(to), ...listPieces(bracket)],
    middle: place((from + to) / 2, LINES.end),
    inside: place((from + to) / 2, 0),
  };
};
