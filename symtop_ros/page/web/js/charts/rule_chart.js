// Chart of Perry's rule: theta'' over phi', with p_psi held as by a push, and with psi' held.

import { draw, findSpan, Frame } from "./plot.js";
import { spread } from "../physics/spread.js";
import { findTiltAcceleration } from "../physics/formulas.js";
import { nameSubject } from "../words/verdict.js";
import { phrase } from "../words/wording.js";

/** @import { Facts } from "../words/facts.js" */

const HEIGHT = 165;
const POINTS = 81;
const LARGEST = 1e4; // rad/s; a root beyond it is not shown

/** @param {number[]} rates */
const keepShown = (rates) => rates.filter((rate) => Math.abs(rate) < LARGEST);

/**
 * @param {Facts} facts
 * @param {import("../physics/state.js").State} state of now
 * @param {number} factor by which Hurry multiplies phi'
 */
export const drawRule = ({ body, start, push_roots: first }, state, factor) => {
  const { theta } = state.angles;
  const subject = nameSubject(body);
  const { phi: rate, psi: spin } = state.rates;
  const along = state.omega[2]; // p_psi/Iz
  const at = (/** @type {number} */ each) =>
    findTiltAcceleration(body, theta, each, along - each * Math.cos(theta));
  const atSpin = (/** @type {number} */ each) => findTiltAcceleration(body, theta, each, spin);
  const roots = keepShown(state.kernel.findRegularRates(body, theta, along, "spin_momentum"));
  const hurried = rate * factor;
  const range = findSpan([0, ...roots, ...keepShown(first), start.phi_dot, rate, hurried], 1);
  const rates = spread(...range, POINTS);
  const [low, high] = findSpan([0, at(rate), at(hurried), ...rates.map(at)], 1);
  const frame = new Frame(HEIGHT, range, [high, low]); // the axis points down: up is a rise
  const place = (/** @type {number} */ each) => /** @type {[number, number]} */ ([each, at(each)]);
  const held = rates.map((each) => /** @type {[number, number]} */ ([each, atSpin(each)]));
  const mark = (/** @type {number} */ root) =>
    `<path class="root" d="M${frame.x(root).toFixed(1)} ${(frame.y(0) - 6).toFixed(1)}v12" stroke="var(--text)" stroke-width="2"/>`;
  draw(
    "rule",
    HEIGHT,
    `${frame.axes}${frame.level(0, 'stroke="var(--grey)"')}
    ${frame.clip(frame.curve(held, 'stroke="var(--grey)" stroke-width="1.5" stroke-dasharray="4 3" id="held"'))}
    ${frame.clip(frame.curve(rates.map(place), 'stroke="var(--phi)" stroke-width="2"'))}
    ${roots.map(mark).join("")}
    ${Math.abs(rate) > 1e-9 ? frame.dot(place(hurried), 'fill="none" stroke="var(--theta)" stroke-width="2" id="hurried"') : ""}
    ${frame.dot(place(rate), 'fill="var(--theta)" id="now"')}
    ${frame.nameVertical(phrase("axis.rises", { subject }))}
    <text x="4" y="${frame.bottom + 24}">${phrase("axis.falls", { subject })}</text>
    ${frame.nameHorizontal(phrase("axis.phi_dot"))}`,
  );
};
