// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { findConstants, findPivotForce } from "../physics/formulas.js";
import { shorten } from "../words/quantities.js";
import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

const ROUNDING = 1e-12;
/** @type {["energy" | "L_z" | "L_z'", string][]} */
const UNITS = [
  ["energy", "J"],
  ["L_z", "N m s"],
  ["L_z'", "N m s"],
];

/** @param {number} value @param {number} change */
const writeChange = (value, change) =>
  Math.abs(change) <= ROUNDING * Math.abs(value)
    ? phrase("table.constant")
    : phrase("table.changed", { change: shorten(change, 2) });

/** @param {[name: string, text: string]} row */
const createRow = ([name, text]) =>
  make("tr", {}, make("th", { scope: "row" }, ...typeset(name)), make("td", {}, text));

let shown = ""; // a table that stays as it is can be read, and its text marked

/**
 * The force of the pivot, where nothing but the weight of a body of known mass acts.
 * @param {import("../run/telling.js").Sample} sample @param {number} mass in kg
 */
const listForce = ({ state, course: { top, clamped, isDriven } }, mass) => {
  if (!Number.isFinite(mass) || clamped || isDriven) return [];
  const { size, upward } = findPivotForce(top, state, mass);
  const text = phrase("table.newtons", { size: shorten(size), upward: shorten(upward) });
  return [[phrase("table.pivot_force", { mass: shorten(mass, 3) }), text]];
};

/**
 * @param {string[][]} rates names and texts
 * @param {import("../run/telling.js").Sample} sample of now
 * @param {number} mass in kg; NaN if no body is the top
 */
export const showConstants = (rates, sample, mass) => {
  const { state, course } = sample;
  const { top, start } = course;
  const [now, before] = [state, start].map((each) => findConstants(top, each));
  const rows = UNITS.map(([name, unit]) => [
    phrase(`table.${name}`),
    `${shorten(now[name], 6)} ${unit}, ${writeChange(now[name], now[name] - before[name])}`,
  ]);
  const all = /** @type {[string, string][]} */ ([...rates, ...listForce(sample, mass), ...rows]);
  if (JSON.stringify(all) === shown) return;
  shown = JSON.stringify(all);
  find("constants").replaceChildren(make("tbody", {}, ...all.map(createRow)));
};
