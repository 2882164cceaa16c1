// Chart of the effective potential: where the energy E' lies above it the tilt may be.

import { draw, Frame, WIDE } from "./plot.js";
import { writeAngle } from "../words/quantities.js";

/** @typedef {import("../words/facts.js").Facts["potential"]} Potential */

const HEIGHT = 150;
const NEAR = 0.1; // of the chart: turning angles that are nearer share a label

/**
 * @param {Frame} frame
 * @param {{theta: number[], height: number[]}} curve
 * @param {number} top
 * @param {string} style
 */
const drawPotential = (frame, { theta, height }, top, style) => {
  const cut = height.map((value) => (value <= top ? value : NaN));
  return frame.curve(
    theta.map((tilt, k) => [tilt, cut[k]]),
    style,
  );
};

/** @param {Potential} potential @param {number} theta now */
export const drawWell = (potential, theta) => {
  const { left, right, bottom, top, energy, angles, before } = potential;
  const frame = new Frame(HEIGHT, [left, right], [bottom, top]);
  const [low, high] = angles.map(frame.x);
  const isNarrow = angles[1] - angles[0] < NEAR * (right - left);
  const named = isNarrow ? [(angles[0] + angles[1]) / 2] : angles;
  draw(
    "well",
    HEIGHT,
    "Effective potential over the tilt",
    `<rect x="${low.toFixed(1)}" y="8" width="${Math.max(high - low, 1).toFixed(1)}" height="${frame.bottom - 8}" fill="var(--band)"/>
    ${frame.axes}
    ${before ? drawPotential(frame, before, top, 'stroke="var(--grey)" stroke-dasharray="4 3" id="before"') : ""}
    ${frame.level(energy, 'stroke="var(--gold)" stroke-width="2"')}
    <text x="${WIDE - 8}" y="${(frame.y(energy) - 4).toFixed(1)}" text-anchor="end">E'</text>
    ${drawPotential(frame, potential, top, 'stroke="var(--phi)" stroke-width="2" id="potential"')}
    ${frame.nameVertical("U in J")}
    ${frame.dot([theta, energy], 'fill="var(--theta)"')}
    ${frame.writeBelow(named, writeAngle)}`,
  );
};
