// Charts of what a fit leaves: measured minus computed over time, one for each column, with the band of a
// standard deviation.

import { draw, Frame } from "./plot.js";
import { COLUMNS, nameResidual } from "../words/fit.js";
import { phrase } from "../words/wording.js";

/** @import { Fitted } from "../fit/answer.js" */
/** @import { Pair } from "./plot.js" */

const HEIGHT = 104;
const [LEAST, MOST] = [4, 8]; // deviations at the edges
const ARM = 3; // units of a cross

/** The id of a column's chart. @param {string} column */
export const nameChart = (column) => `residuals-${column}`;

/** A point that was left out: a cross, or a triangle at the edge beyond which it is. @param {Frame} frame @param {Pair} point @param {number} edge */
const drawOutlier = (frame, [time, left], edge) => {
  const x = frame.x(time).toFixed(1);
  const isBeyond = Math.abs(left) > edge;
  const y = frame.y(Math.max(-edge, Math.min(left, edge)));
  const way = left > 0 ? ARM : -ARM;
  const path = isBeyond
    ? `M${x} ${y.toFixed(1)}l${-ARM} ${2 * way}h${2 * ARM}z`
    : `M${x} ${y.toFixed(1)}m${-ARM} ${-ARM}l${2 * ARM} ${2 * ARM}m0 ${-2 * ARM}l${-2 * ARM} ${2 * ARM}`;
  return `<path class="left-out" d="${path}" fill="${isBeyond ? "var(--red)" : "none"}" stroke="var(--red)" stroke-width="1.4"/>`;
};

/** @param {Fitted} fitted @param {number} place of the column */
const drawColumn = ({ kind, times, residuals, sigma, outliers }, place) => {
  const size = sigma[place];
  const points = times.map(
    (time, row) => /** @type {Pair} */ ([time, -residuals[row][place]]), // measured minus computed
  );
  const out = new Set(outliers);
  const farthest = Math.max(...points.map(([, left]) => Math.abs(left)));
  const edge = Math.max(LEAST * size, Math.min(1.1 * farthest, MOST * size));
  const [begin, end] = [times[0], times[times.length - 1]];
  const frame = new Frame(HEIGHT, [begin, end], [-edge, edge], 5);
  /** @type {Pair[]} */
  const band = [
    [begin, -size],
    [end, -size],
    [end, size],
    [begin, size],
  ];
  const column = COLUMNS[kind][place];
  const unit = nameResidual(kind);
  const kept = points.filter((_, row) => !out.has(row));
  const label = { column, size, unit, count: kept.length, out: outliers.length || null };
  draw(
    nameChart(column),
    HEIGHT,
    `${frame.curve(band, 'class="sigma" fill-opacity="0.16"', "var(--blue)")}
    ${frame.axes}
    ${frame.level(0, 'stroke="var(--grey)"')}
    ${frame.dots(kept, 'class="residuals"')}
    ${outliers.map((row) => drawOutlier(frame, points[row], edge)).join("")}
    ${frame.nameVertical(unit ? `${column}, ${unit}` : column)}
    ${frame.nameHorizontal(phrase("axis.time"))}`,
    phrase("fitted.residuals_label", label),
  );
};

/** Draw all columns into their places. @param {Fitted} fitted */
export const drawResiduals = (fitted) => {
  for (const place of fitted.sigma.keys()) drawColumn(fitted, place);
};
