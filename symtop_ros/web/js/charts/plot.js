// Axes and curves of a chart, as SVG.

import { find } from "../controls/document.js";
import { shorten } from "../words/quantities.js";

const SVG = "http://www.w3.org/2000/svg";
export const WIDE = 300; // units of the drawing
export const LEFT = 44; // of the axes
const [RIGHT, UPPER, LOWER] = [6, 8, 18]; // margins
const FAR = 1e4; // units; out of the drawing

/** @typedef {[number, number]} Pair */
/** @typedef {(value: number) => number} Scale */
/** @typedef {{x: Scale, y: Scale, bottom: number, axes: string}} Frame */

/**
 * Put a drawing into the place of a chart.
 * @param {string} id
 * @param {number} height
 * @param {string} label
 * @param {string} drawing
 */
export const draw = (id, height, label, drawing) => {
  const place = find(id);
  if (!place.firstElementChild) {
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", `0 0 ${WIDE} ${height}`);
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", label);
    place.append(svg);
  }
  if (place.firstElementChild) place.firstElementChild.innerHTML = drawing;
};

/**
 * Round values between two, about so many.
 * @param {number} low
 * @param {number} high
 * @param {number} count
 */
export const listTicks = (low, high, count) => {
  const rough = (high - low) / count;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * size).find((each) => each >= rough * 0.999) ?? rough;
  // Of values far larger than their span some are equal: a loop that counts up to `high` may not end.
  const first = Math.ceil(low / step);
  const found = Array.from({ length: count + 2 }, (_, k) => (first + k) * step);
  const inside = found.filter((value) => value >= low && value <= high);
  return [...new Set(inside.map((value) => Number(value.toPrecision(10))))];
};

/**
 * The place of a value, outside of the drawing if the value is beyond what an axis can show; NaN, a
 * gap, for a value that is no number.
 * @param {number} value
 * @param {number} place
 */
const keepNear = (value, place) => {
  if (Number.isNaN(place)) return Number.isNaN(value) ? NaN : FAR;
  return Math.min(Math.max(place, -FAR), FAR);
};

/**
 * Axes: `low` and `high` are the values at the lower and the upper edge, in this order.
 * @param {number} height
 * @param {Pair} horizontal
 * @param {Pair} vertical
 * @param {number} marks
 * @param {Scale} shown a value in the unit of the page
 * @returns {Frame}
 */
export const createFrame = (
  height,
  [left, right],
  [low, high],
  marks = 4,
  shown = (value) => value,
) => {
  const bottom = height - LOWER;
  const x = (/** @type {number} */ value) =>
    keepNear(value, LEFT + ((value - left) / (right - left)) * (WIDE - LEFT - RIGHT));
  const y = (/** @type {number} */ value) =>
    keepNear(value, bottom - ((value - low) / (high - low)) * (bottom - UPPER));
  const ticks = listTicks(shown(Math.min(low, high)), shown(Math.max(low, high)), marks);
  const axes = ticks.map((value) => {
    const place = y(value / (shown(1) || 1));
    return `${level(place, 'class="axis"')}
      <text class="tick" x="${LEFT - 4}" y="${(place + 3).toFixed(1)}" text-anchor="end">${shorten(value, 5)}</text>`;
  });
  return { x, y, bottom, axes: axes.join("") };
};

/** A line across the chart. @param {number} height @param {string} style */
export const level = (height, style) =>
  `<path d="M${LEFT} ${height.toFixed(1)}H${WIDE - RIGHT}" ${style}/>`;

/**
 * Values below the axes.
 * @param {Frame} frame
 * @param {number[]} values
 * @param {(value: number) => string} write
 */
export const writeBelow = (frame, values, write = (value) => shorten(value, 5)) =>
  values
    .map(
      (value) => `<text class="tick" x="${frame.x(value).toFixed(1)}" y="${frame.bottom + 12}"
    text-anchor="middle">${write(value)}</text>`,
    )
    .join("");

/**
 * A curve, with gaps where its height is no number.
 * @param {Pair[]} points in units of the drawing
 * @param {string} style
 */
export const drawCurve = (points, style) => {
  let text = "";
  let pen = "M";
  for (const [x, y] of points) {
    if (Number.isFinite(y)) text += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = Number.isFinite(y) ? "L" : "M";
  }
  return `<path d="${text}" fill="none" ${style}/>`;
};

/** A dot. @param {number} x @param {number} y @param {string} style */
export const drawDot = (x, y, style) =>
  `<circle cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="5" ${style}/>`;

/**
 * An interval around numbers, with some room; of `least` at least, so that no rounding is shown.
 * @param {number[]} numbers
 * @param {number} least
 * @returns {Pair}
 */
export const findSpan = (numbers, least) => {
  let [low, high] = [Infinity, -Infinity];
  for (const value of numbers) {
    if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  }
  if (low > high) return [0, 1];
  const more = Math.max(0.06 * (high - low), (least - (high - low)) / 2, 1e-9);
  return [low - more, high + more];
};
