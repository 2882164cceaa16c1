// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { findConstants } from "../physics/formulas.js";
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

/** @param {string[][]} rates names and texts @param {import("../run/local.js").Sample} sample of now */
export const showConstants = (rates, { state, course: { top, start } }) => {
  const [now, before] = [state, start].map((each) => findConstants(top, each));
  const rows = UNITS.map(([name, unit]) => [
    phrase(`table.${name}`),
    `${shorten(now[name], 6)} ${unit}, ${writeChange(now[name], now[name] - before[name])}`,
  ]);
  const all = /** @type {[string, string][]} */ ([...rates, ...rows]);
  if (JSON.stringify(all) === shown) return;
  shown = JSON.stringify(all);
  find("constants").replaceChildren(make("tbody", {}, ...all.map(createRow)));
};
