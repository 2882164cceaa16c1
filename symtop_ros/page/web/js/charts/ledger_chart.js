// Chart of the energy: what the last kick put into its parts, as bars.

import { find, say } from "../controls/document.js";
import { findRest } from "../physics/formulas.js";
import { ROUNDING } from "../words/ledger.js";
import { draw, findSpan, Frame } from "./plot.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Energies } from "../physics/formulas.js" */
/** @import { Ledger } from "../words/ledger.js" */

const HEIGHT = 160;
const WIDTH = 0.24; // of a bar; groups are 1 apart
/** @type {[name: string, color: string, pick: (parts: Energies) => number][]} */
const BARS = [
  ["weight", "var(--theta)", ({ weight }) => weight],
  ["precession", "var(--phi)", ({ precession }) => precession],
  ["nutation", "var(--grey)", ({ nutation }) => nutation],
  ["E\u2032", "var(--gold)", findRest],
];

/** @param {number} value */
const writeSigned = (value) =>
  value ? `${value > 0 ? "+" : "\u2212"}${shorten(Math.abs(value), 3)}` : "0";

/** @param {Ledger} ledger @returns {number[][]} heights in mJ of each group */
const listHeights = ({ kick, far }) => {
  const heights = [kick, far].map((parts) => BARS.map(([, , pick]) => pick(parts)));
  const least = ROUNDING * Math.max(...heights.flat().map(Math.abs), 0);
  return heights.map((group) => group.map((each) => (Math.abs(each) > least ? each : 0)));
};

/** @param {Frame} frame @param {number} group @param {number} place @param {number} height */
const drawBar = (frame, group, place, height) => {
  const left = frame.x(group + WIDTH * (place - BARS.length / 2));
  const right = frame.x(group + WIDTH * (place + 1 - BARS.length / 2)) - 1;
  const [zero, end] = [frame.y(0), frame.y(height)];
  const middle = ((left + right) / 2).toFixed(1);
  const above = height < 0 ? end + 10 : end - 3;
  const bar = `<rect x="${left.toFixed(1)}" y="${Math.min(zero, end).toFixed(1)}" fill="${BARS[place][1]}"
      width="${(right - left).toFixed(1)}" height="${Math.abs(end - zero).toFixed(1)}"/>`;
  const number = `<text class="tick bar" x="${middle}" y="${above.toFixed(1)}" text-anchor="middle">${writeSigned(height)}</text>`;
  return { bar, number };
};

/** @param {Ledger | null} ledger @param {string} sentence */
export const drawLedger = (ledger, sentence) => {
  find("ledger-chart").hidden = !ledger;
  if (!ledger) return;
  const heights = listHeights(ledger);
  const [low, high] = findSpan([0, ...heights.flat()], 1e-6);
  const room = 0.12 * (high - low);
  const frame = new Frame(HEIGHT, [-0.5, 1.5], [low - room, high + room]);
  const bars = heights.flatMap((group, g) =>
    group.map((height, k) => drawBar(frame, g, k, height)),
  );
  const list = (/** @type {"bar" | "number"} */ kind) => bars.map((each) => each[kind]).join("");
  const names = ["kick", ledger.point].map(
    (key, group) =>
      `<text class="tick" x="${frame.x(group)}" y="${frame.bottom + 12}" text-anchor="middle">${phrase(`ledger.bar_${key}`)}</text>`,
  );
  draw(
    "ledger",
    HEIGHT,
    `${frame.level(0, 'stroke="var(--grey)"')}${list("bar")}${list("number")}${names.join("")}`,
    sentence,
  );
  say("ledger-text", sentence);
};
