// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { findConstants, findPivotForce, findSizes } from "../physics/formulas.js";
import { shorten } from "../words/quantities.js";
import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

const ROUNDING = 1e-12; // of the sizes of the parts of a constant, which may be nearly opposite
/** @type {["energy" | "L_z" | "L_z'", string][]} */
const UNITS = [
  ["energy", "J"],
  ["L_z", "N m s"],
  ["L_z'", "N m s"],
];

/** A constant that rounding alone may have made is none. @param {number} value @param {number} least */
const dropRounding = (value, least) => (Math.abs(value) <= least ? 0 : value);

/** @param {number} change that is not rounding, or 0 */
const writeChange = (change) =>
  change ? phrase("table.changed", { change: shorten(change, 2) }) : phrase("table.constant");

/** @param {[name: string, text: string]} row */
const createRow = ([name, text]) =>
  make("tr", {}, make("th", { scope: "row" }, ...typeset(name)), make("td", {}, text));

let shown = ""; // a table that stays as it is can be read, and its text marked

/**
 * The force of the pivot, where nothing but the weight of a body of known mass acts.
 * @param {import("../run/telling.js").Sample} sample
 * @param {number} assumed mass in kg, where none is known
 */
const listForce = ({ state, course: { top, clamped, isDriven, weighed } }, assumed) => {
  const mass = weighed.mass || assumed;
  if (!Number.isFinite(mass) || clamped || isDriven) return [];
  const { size, upward } = findPivotForce(top, state, mass, weighed.gravity);
  const text = phrase("table.newtons", { size: shorten(size), upward: shorten(upward) });
  return [[phrase("table.pivot_force", { mass: shorten(mass, 3) }), text]];
};

/**
 * @param {string[][]} rates names and texts
 * @param {import("../run/telling.js").Sample} sample of now
 * @param {number} mass in kg, of a body that is the top; NaN if there is none
 */
export const showConstants = (rates, sample, mass) => {
  const { state, course } = sample;
  const { top, start } = course;
  const [now, before] = [state, start].map((each) => findConstants(top, each));
  const sizes = findSizes(top, state);
  const rows = UNITS.map(([name, unit]) => {
    const least = ROUNDING * sizes[name];
    const change = dropRounding(now[name] - before[name], least);
    const value = shorten(dropRounding(now[name], least), 6);
    return [phrase(`table.${name}`), `${value} ${unit}, ${writeChange(change)}`];
  });
  const all = /** @type {[string, string][]} */ ([...rates, ...listForce(sample, mass), ...rows]);
  if (JSON.stringify(all) === shown) return;
  shown = JSON.stringify(all);
  find("constants").replaceChildren(make("tbody", {}, ...all.map(createRow)));
};
