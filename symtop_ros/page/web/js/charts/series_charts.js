// Charts of tilt, precession and spin over the time of the motion.

import { draw, findSpan, Frame } from "./plot.js";
import { drawMarks, placeMarks } from "./seen_points.js";
import { NANO } from "../physics/course.js";
import { angleUnit, toUnit } from "../words/quantities.js";
import { nameSubject } from "../words/verdict.js";
import { phrase } from "../words/wording.js";

/** @import { Top } from "../physics/kernel.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Sample } from "../run/telling.js" */
/** @import { Pair } from "./plot.js" */
/** @import { Mark, Marks } from "../run/marks.js" */
/** @typedef {{pick: (state: State) => number, color: string, least: number, isTilt: boolean}} Series */

const HEIGHT = 119;
const SHARE = 0.02; // of a quantity, which its chart spans at least

/** @param {State} state */
const findTilt = ({ angles }) => angles.theta;

/** @type {{[id: string]: Series}} */
const SERIES = {
  theta: { pick: findTilt, color: "var(--theta)", least: 0.01, isTilt: true },
  phi_dot: { pick: ({ rates }) => rates.phi, color: "var(--phi)", least: 0.1, isTilt: false },
  psi_dot: { pick: ({ rates }) => rates.psi, color: "var(--psi)", least: 0.1, isTilt: false },
};

/**
 * Values at the lower and the upper edge; points that are far from the curve are not seen.
 * @param {Pair[]} own @param {Pair[]} ghost @param {Pair[]} seen @param {Series} series @returns {Pair}
 */
const findEdges = (own, ghost, seen, { least, isTilt }) => {
  const curves = [...own, ...ghost].map(([, value]) => value);
  const [lower, upper] = findSpan(curves, least);
  const near = seen.map(([, value]) =>
    Math.min(Math.max(value, 2 * lower - upper), 2 * upper - lower),
  );
  const values = [...curves, ...near];
  if (!isTilt) return findSpan(values, Math.max(least, SHARE * Math.abs(values[0])));
  const [low, high] = findSpan(values, least);
  return [high, low]; // a small tilt is high
};

/**
 * The range of time, and the kicks in it.
 * @param {number} first s
 * @param {number} now s
 * @param {{window: number, marks: number[]}} facts
 * @returns {{range: Pair, kicks: number[]}}
 */
const findRange = (first, now, { window, marks }) => {
  const begin = Math.max(now - window, first);
  const kicks = marks.filter((time) => time >= begin && time <= now);
  return { range: [begin, Math.max(now, begin + window / 20)], kicks };
};

/**
 * @param {"theta" | "phi_dot" | "psi_dot"} id
 * @param {Sample[]} samples
 * @param {{window: number, marks: number[], body: Top}} facts
 * @param {Mark[]} marks of measured points @param {Marks} all
 */
export const drawOneSeries = (id, samples, facts, marks, all) => {
  const { pick, color, isTilt } = SERIES[id];
  const list = (/** @type {"state" | "ghost"} */ whose) =>
    samples.map(({ time, [whose]: state }) => {
      return /** @type {Pair} */ ([time / NANO, state ? pick(state) : NaN]);
    });
  const own = list("state");
  const ghost = isTilt ? list("ghost") : [];
  const { range, kicks } = findRange(own[0][0], own[own.length - 1][0], facts);
  const placed = placeMarks(marks, [id], ({ time, state }) => [time / NANO, pick(state)]);
  const seen = placed.map(({ point }) => point);
  const edges = findEdges(own, ghost, seen, SERIES[id]);
  const frame = new Frame(HEIGHT, range, edges, 3, isTilt ? toUnit : undefined);
  const mark = (/** @type {number} */ time) =>
    frame.upright(time, 'class="kick" stroke="var(--gold)" stroke-width="1.5"');
  draw(
    id,
    HEIGHT,
    `${frame.axes}${kicks.map(mark).join("")}
    ${frame.curve(ghost, 'stroke="var(--grey)" stroke-width="1.5" stroke-dasharray="4 3" class="ghost"')}
    ${frame.curve(own, `stroke="${color}" stroke-width="1.8"`)}
    ${drawMarks(id, frame, all, placed)}
    ${frame.dot(own[own.length - 1], `fill="${color}"`)}
    ${frame.nameVertical(isTilt ? phrase("axis.tilt", { unit: angleUnit(), subject: nameSubject(facts.body) }) : "rad/s")}
    ${frame.nameHorizontal(phrase("axis.time"))}`,
  );
};
