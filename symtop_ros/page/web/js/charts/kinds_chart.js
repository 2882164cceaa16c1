// Chart of the kinds of motion over psi' and phi', with the present motion as a dot.

import { find } from "../controls/document.js";
import { findBoundaries, makesLoops } from "../physics/kinds.js";
import { draw, findSpan, Frame } from "./plot.js";
import { spread } from "../physics/spread.js";
import { phrase } from "../words/wording.js";

/** @import { Top } from "../physics/kernel.js" */
/** @import { Pair } from "./plot.js" */
/** @import { Turning } from "../physics/kinds.js" */

const HEIGHT = 205;
const [ROWS, COLUMNS] = [86, 84]; // cells of the regions
const OVERLAP = 0.3; // of rows, so that no gaps are seen between them
const POINTS = 200; // of a boundary, on each side of phi' = 0
const LARGEST = 200; // rad/s; rates of regular precession beyond it do not widen the map
/** @type {{[name: string]: string}} */
const LOOKS = {
  cusps: 'stroke="var(--red)" stroke-width="2" class="cusps"',
  regular: 'stroke="var(--text)" stroke-width="1.6" stroke-dasharray="6 3" class="regular"',
  upper: 'stroke="var(--grey)" stroke-width="1.4" stroke-dasharray="2 2"',
  lower: 'stroke="var(--grey)" stroke-width="1.4" stroke-dasharray="2 2"',
};

/** The ranges of psi' and of phi'. @param {Turning} turning @returns {[Pair, Pair]} */
const findRanges = ({ phi_dot, psi_dot, roots: all }) => {
  const roots = all.filter((rate) => Math.abs(rate) < LARGEST);
  const spin = 1.6 * Math.max(Math.abs(psi_dot), 100);
  const [low, high] = findSpan([0, phi_dot, ...roots, -10, 10], 1);
  const room = 0.25 * (high - low);
  return [
    [-spin, spin],
    [low - room, high + room],
  ];
};

/**
 * Where motions make loops: rows of cells, as one path.
 * @param {Frame} frame @param {Top} top @param {number} theta @param {[Pair, Pair]} ranges
 */
const drawLoops = (frame, top, theta, [[left, right], [low, high]]) => {
  const [width, height] = [(right - left) / COLUMNS, (high - low) / ROWS];
  const tall = (frame.y(0) - frame.y(height) + OVERLAP).toFixed(1);
  let path = "";
  for (let row = 0; row < ROWS; row += 1) {
    const phi = low + (row + 0.5) * height;
    const y = frame.y(phi + height / 2).toFixed(1);
    let begin = -1; // of a run of cells
    for (let column = 0; column <= COLUMNS; column += 1) {
      const psi = left + (column + 0.5) * width;
      const isInside = column < COLUMNS && makesLoops(top, theta, phi, psi);
      if (isInside && begin < 0) begin = column;
      if (isInside || begin < 0) continue;
      const x = frame.x(left + begin * width);
      const wide = (frame.x(left + column * width) - x).toFixed(1);
      path += `M${x.toFixed(1)} ${y}h${wide}v${tall}h-${wide}z`;
      begin = -1;
    }
  }
  return `<path d="${path}" fill="var(--loops)"/>`;
};

/** @param {Frame} frame @param {Top} top @param {number} theta @param {[Pair, Pair]} ranges */
const drawBoundaries = (frame, top, theta, [[left, right], [low, high]]) => {
  const [below, above] = [low, high].map((end) => (0.5 / POINTS) * end); // next to phi' = 0
  const sides = [spread(low - below, below, POINTS), spread(above, high - above, POINTS)];
  const cut = (/** @type {number} */ psi) => (psi >= left && psi <= right ? psi : NaN);
  return sides
    .flatMap((side) => {
      const found = side.map((phi) => ({ phi, ...findBoundaries(top, theta, phi) }));
      return Object.entries(LOOKS).map(([name, style]) => {
        const points = found.map((each) => {
          const psi = cut(each[/** @type {"cusps" | "regular" | "upper" | "lower"} */ (name)]);
          return /** @type {Pair} */ ([psi, Number.isNaN(psi) ? NaN : each.phi]);
        });
        return frame.curve(points, style);
      });
    })
    .join("");
};

/** What was drawn last: regions and boundaries hold for a top and a tilt. */
const drawn = { key: "", text: "" };

/** @param {Top} top @param {Turning | null} turning */
export const drawKinds = (top, turning) => {
  find("kinds-chart").hidden = !turning;
  if (!turning) return;
  const ranges = findRanges(turning);
  const [horizontal, vertical] = ranges;
  const frame = new Frame(HEIGHT, horizontal, vertical);
  const key = JSON.stringify([top, turning.theta, ranges]);
  if (key !== drawn.key) {
    const parts = [drawLoops, drawBoundaries].map((part) =>
      part(frame, top, turning.theta, ranges),
    );
    Object.assign(drawn, { key, text: parts[0] + frame.axes + parts[1] });
  }
  draw(
    "kinds",
    HEIGHT,
    `${drawn.text}${frame.level(0, LOOKS.cusps)}
    ${frame.dot([turning.psi_dot, turning.phi_dot], 'fill="var(--theta)" id="present"')}
    ${frame.nameVertical(phrase("axis.phi_dot"))}
    ${frame.nameHorizontal(phrase("axis.psi_dot"))}`,
  );
};
