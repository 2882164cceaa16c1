// Chart of the effective potential: where the energy E' lies above it the tilt may be.

import { draw, Frame } from "./plot.js";
import { writeAngle } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @typedef {import("../words/facts.js").Facts["potential"]} Potential */

const HEIGHT = 165;

/** @param {Frame} frame @param {{theta: number[], height: number[]}} curve @param {string} style */
const drawPotential = (frame, { theta, height }, style) =>
  frame.clip(
    frame.curve(
      theta.map((tilt, k) => [tilt, height[k]]),
      style,
    ),
  );

/** @param {Potential} potential @param {number} theta now */
export const drawWell = (potential, theta) => {
  const { left, right, bottom, top, energy, angles, before } = potential;
  const frame = new Frame(HEIGHT, [left, right], [bottom, top]);
  draw(
    "well",
    HEIGHT,
    `${frame.band(angles, 'fill="var(--band)"')}
    ${frame.axes}
    ${before ? drawPotential(frame, before, 'stroke="var(--grey)" stroke-dasharray="4 3" id="before"') : ""}
    ${frame.level(energy, 'stroke="var(--gold)" stroke-width="2"')}
    ${frame.nameLevel(energy, "E\u2032")}
    ${drawPotential(frame, potential, 'stroke="var(--phi)" stroke-width="2" id="potential"')}
    ${frame.nameVertical(phrase("axis.U"))}
    ${frame.nameHorizontal("\u03b8", frame.writeBelow(angles, writeAngle))}
    ${frame.dot([theta, energy], 'fill="var(--theta)"')}`,
  );
};
