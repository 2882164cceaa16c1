// Measured points in a chart: those that show what it shows, and the one that is pointed at.

import { WIDE } from "./plot.js";

/** @import { Frame, Pair } from "./plot.js" */
/** @import { Mark, Marks } from "../run/marks.js" */

/**
 * Points of a chart with their marks; those that do not show its quantities are left out.
 * @param {Mark[]} marks @param {string[]} wanted names of quantities @param {(mark: Mark) => Pair} measure
 */
export const placeMarks = (marks, wanted, measure) =>
  marks
    .filter(({ shows }) => wanted.every((each) => each === "time" || shows.includes(each)))
    .map((mark) => ({ mark, point: measure(mark) }));

/**
 * @param {string} id of the chart @param {Frame} frame @param {Marks} all
 * @param {ReturnType<typeof placeMarks>} placed
 */
export const drawMarks = (id, frame, all, placed) => {
  const dots = placed.map(({ mark, point }) => {
    const [x, y] = frame.place(point);
    return /** @type {[number, number, number]} */ ([x, y, mark.place]);
  });
  all.keep(id, dots, WIDE);
  const pointed = placed.find(({ mark }) => mark.place === all.pointed);
  const ring = pointed
    ? frame.dot(pointed.point, 'fill="none" stroke="var(--text)" class="pointed"')
    : "";
  const points = placed.map(({ point }) => point);
  return points.length ? frame.dots(points, 'class="seen"') + ring : "";
};
