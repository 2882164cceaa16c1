// Charts of tilt, precession and spin over the time of the motion.

import { draw, findSpan, Frame } from "./plot.js";
import { angleUnit, toUnit } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Row } from "../run/local.js" */
/** @typedef {{column: number, color: string, least: number, isTilt: boolean}} Series */

const HEIGHT = 119;
const SHARE = 0.02; // of a quantity, which its chart spans at least
const GHOST = 4; // column of theta of the ghost
/** @type {{[id: string]: Series}} */
const SERIES = {
  theta: { column: 1, color: "var(--theta)", least: 0.01, isTilt: true },
  phi_dot: { column: 2, color: "var(--phi)", least: 0.1, isTilt: false },
  psi_dot: { column: 3, color: "var(--psi)", least: 0.1, isTilt: false },
};

/** @param {number | null} value */
const orGap = (value) => value ?? NaN;

/**
 * @param {Row[]} rows
 * @param {Series} series
 * @returns {[number, number]} values at the lower and the upper edge
 */
const findEdges = (rows, { column, least, isTilt }) => {
  const values = rows.map((row) => orGap(row[column]));
  if (isTilt) {
    const [low, high] = findSpan([...values, ...rows.map((row) => orGap(row[GHOST]))], least);
    return [high, low]; // a small tilt is high
  }
  return findSpan(values, Math.max(least, SHARE * Math.abs(values[0])));
};

/**
 * The range of time, and the kicks in it.
 * @param {Row[]} rows
 * @param {{window: number, marks: number[]}} facts
 * @returns {{range: [number, number], kicks: number[]}}
 */
const findRange = (rows, { window, marks }) => {
  const now = rows[rows.length - 1][0];
  const begin = Math.max(now - window, rows[0][0]);
  const kicks = marks.filter((time) => time >= begin && time <= now);
  return { range: [begin, Math.max(now, begin + window / 20)], kicks };
};

/**
 * @param {"theta" | "phi_dot" | "psi_dot"} id
 * @param {Row[]} rows
 * @param {{window: number, marks: number[]}} facts
 */
export const drawOneSeries = (id, rows, facts) => {
  const { column, color, isTilt } = SERIES[id];
  const { range, kicks } = findRange(rows, facts);
  const edges = findEdges(rows, SERIES[id]);
  const frame = new Frame(HEIGHT, range, edges, 3, isTilt ? toUnit : undefined);
  const line = (/** @type {number} */ k, /** @type {string} */ style) =>
    frame.curve(
      rows.map((row) => [row[0], orGap(row[k])]),
      style,
    );
  const mark = (/** @type {number} */ time) =>
    frame.upright(time, 'class="kick" stroke="var(--gold)" stroke-width="1.5"');
  draw(
    id,
    HEIGHT,
    `${frame.axes}${kicks.map(mark).join("")}
    ${isTilt ? line(GHOST, 'stroke="var(--grey)" stroke-width="1.5" stroke-dasharray="4 3" class="ghost"') : ""}
    ${line(column, `stroke="${color}" stroke-width="1.8"`)}
    ${frame.nameVertical(isTilt ? phrase("axis.tilt", { unit: angleUnit() }) : "rad/s")}
    ${frame.nameHorizontal(phrase("axis.time"))}`,
  );
};
