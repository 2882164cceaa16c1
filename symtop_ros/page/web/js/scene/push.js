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

export const BRACKET = 1.14; // its distance from the pivot
const INNER = 1.02; // where its ends begin
const LEVEL = 0.3; // rad; half of the two levels of the bracket
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
 * The two levels next to the axle, and the bracket between them, as pieces of lines.
 * @param {{from: number, to: number}} levels @param {number} phi
 */
export const listBracket = ({ from, to }, phi) => {
  const level = (/** @type {number} */ theta) =>
    listPieces(spread(phi - LEVEL, phi + LEVEL, 13).map((each) => findPoint(theta, each, INNER)));
  const arc = spread(from, to, 13).map((theta) => findPoint(theta, phi, BRACKET));
  const ends = [from, to].map((theta) => findPoint(theta, phi, INNER));
  return [...level(from), ...level(to), ...listPieces([ends[0], ...arc, ends[1]])];
};
