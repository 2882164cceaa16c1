// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { shorten } from "../words/quantities.js";
import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

/** @typedef {{[name: string]: [value: number, change: number, unit: string]}} Constants */

const ROUNDING = 1e-12;

/** @param {number} value @param {number} change */
const writeChange = (value, change) =>
  Math.abs(change) <= ROUNDING * Math.abs(value)
    ? phrase("table.constant")
    : phrase("table.changed", { change: shorten(change, 2) });

/** @param {[name: string, text: string]} row */
const createRow = ([name, text]) =>
  make("tr", {}, make("th", { scope: "row" }, ...typeset(name)), make("td", {}, text));

let shown = ""; // a table that stays as it is can be read, and its text marked

/** @param {string[][]} rates names and texts @param {Constants} constants */
export const showConstants = (rates, constants) => {
  const rows = Object.entries(constants).map(([name, [value, change, unit]]) => [
    phrase(`table.${name}`),
    `${shorten(value, 6)} ${unit}, ${writeChange(value, change)}`,
  ]);
  const all = /** @type {[string, string][]} */ ([...rates, ...rows]);
  if (JSON.stringify(all) === shown) return;
  shown = JSON.stringify(all);
  find("constants").replaceChildren(make("tbody", {}, ...all.map(createRow)));
};
