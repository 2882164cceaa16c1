// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { shorten } from "../words/quantities.js";
import { typeset } from "../words/typeset.js";

/** @typedef {{[name: string]: [value: number, change: number, unit: string]}} Constants */

/** @type {{[name: string]: string}} */
const NAMES = {
  energy: "energy E",
  L_z: "L_z, about the axis of the top",
  "L_z'": "L_z', about the vertical",
};
const ROUNDING = 1e-12;

/**
 * @param {number} value
 * @param {number} change
 */
const writeChange = (value, change) =>
  Math.abs(change) <= ROUNDING * Math.abs(value) ? "constant" : `changed by ${shorten(change, 2)}`;

/**
 * @param {string} name
 * @param {string} text
 */
const createRow = (name, text) =>
  make("tr", {}, make("th", { scope: "row" }, ...typeset(name)), make("td", {}, text));

/**
 * @param {string[][]} rates names and texts
 * @param {Constants} constants
 */
export const showConstants = (rates, constants) => {
  const rows = Object.entries(constants).map(([name, [value, change, unit]]) =>
    createRow(NAMES[name], `${shorten(value, 6)} ${unit}, ${writeChange(value, change)}`),
  );
  find("constants").replaceChildren(
    make("tbody", {}, ...rates.map(([name, text]) => createRow(name, text)), ...rows),
  );
};
