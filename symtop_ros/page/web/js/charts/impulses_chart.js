// Chart of the impulses of one fall, or one rise: the torques about the line of nodes from the last event
// to half a nutation, their areas filled up to now, and below them theta', of which the change is the sum
// over Ix.

import { find } from "../controls/document.js";
import { findFrameTorques } from "../physics/formulas.js";
import { findImpulses } from "./impulses.js";
import { draw, findSpan, Frame } from "./plot.js";
import { spread } from "../physics/spread.js";
import { NANO } from "../physics/course.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Pair } from "./plot.js" */
/** @typedef {{time: number, rate: number, torques: ReturnType<typeof findFrameTorques>}} Instant */

const HEIGHTS = [150, 105]; // of the torques, and of theta'
const LOWER = 20; // of the torques: their times are written below theta'
const POINTS = 201;
const MILLI = 1000;
const DIGITS = 4;
const ZERO = 1e-6; // of the sizes of the parts: their sum is shown with no more digits than they are
/** @type {[keyof Instant["torques"], string][]} */
const LOOKS = [
  ["gravity", "var(--theta)"],
  ["coriolis", "var(--phi)"],
  ["centrifugal", "var(--psi)"],
  ["total", "var(--text)"],
];

/** The torques of a motion in half a nutation, under gravity alone. @param {Course} course @returns {Instant[]} */
export const listFall = (course) => {
  const half = course.motion.nutation_period / 2;
  if (!Number.isFinite(half) || course.isDriven) return [];
  return spread(0, half, POINTS).map((time) => {
    const { angles, rates } = course.at(Math.round(time * NANO));
    const torques = findFrameTorques(course.top, angles.theta, rates.phi, rates.psi);
    return { time, rate: rates.theta, torques };
  });
};

/**
 * The impulses up to now, as texts: of the parts, and of their sum.
 * @param {Course} course @param {number} passed s
 */
export const writeImpulses = (course, passed) => {
  const parts = findImpulses(course, course.at(Math.round(passed * NANO)), passed);
  const sum = parts.reduce((total, each) => total + each, 0);
  const size = parts.reduce((total, each) => total + Math.abs(each), 0);
  return [...parts, Math.abs(sum) <= ZERO * size ? 0 : sum].map((each) =>
    shorten(MILLI * each, DIGITS),
  );
};

/** The motion that was drawn last, and its torques. @type {{course: Course | null, fall: Instant[]}} */
const drawn = { course: null, fall: [] };

/** @param {Course} course @param {number} passed s since the last event */
export const drawImpulses = (course, passed) => {
  if (course !== drawn.course) Object.assign(drawn, { course, fall: listFall(course) });
  const { fall } = drawn;
  find("impulses").hidden = !fall.length;
  const past = fall.filter(({ time }) => time <= passed + 1 / NANO);
  if (!fall.length) return;
  const last = fall[fall.length - 1].time;
  const end = Math.min(Math.max(passed, 0), last);
  const texts = writeImpulses(course, end);
  LOOKS.forEach(([name], k) => {
    find(`impulse-${name}`).textContent = texts[k];
  });
  const heights = fall.flatMap(({ torques }) => Object.values(torques));
  const upper = new Frame(HEIGHTS[0], [0, last], findSpan([0, ...heights], 1e-9), 3);
  const rates = fall.map(({ rate }) => rate);
  const lower = new Frame(HEIGHTS[1], [0, last], findSpan([0, ...rates], 1e-3), 2);
  const curves = LOOKS.map(([name, color]) => {
    const line = fall.map(({ time, torques }) => /** @type {Pair} */ ([time, torques[name]]));
    /** @type {Pair[]} */
    const area = [[0, 0], ...line.slice(0, past.length), [end, 0]];
    const fill = name === "total" ? "" : upper.curve(area, 'fill-opacity="0.3"', color);
    return fill + upper.curve(line, `stroke="${color}" stroke-width="1.8"`);
  });
  const now = (/** @type {Frame} */ frame) => frame.upright(end, 'stroke="var(--gold)"');
  const zero = (/** @type {Frame} */ frame) => frame.level(0, 'stroke="var(--grey)"');
  draw(
    "impulses",
    HEIGHTS[0] + HEIGHTS[1] - LOWER,
    `${upper.axes}${zero(upper)}${curves.join("")}${now(upper)}${upper.nameVertical("N m")}
    <g transform="translate(0,${HEIGHTS[0] - LOWER})">${lower.axes}${zero(lower)}${now(lower)}
    ${lower.curve(
      fall.map(({ time, rate }) => [time, rate]),
      'stroke="var(--text)" stroke-width="1.8"',
    )}
    ${lower.nameVertical(phrase("axis.theta_dot"))}${lower.nameHorizontal(phrase("axis.time"))}</g>`,
  );
};
