// The table of what is constant in a motion, and by how much it has changed.

import { find, make } from "../controls/document.js";
import { findConstants, findPivotForce, findSizes } from "../physics/formulas.js";
import { NANO } from "../physics/course.js";
import { shorten } from "../words/quantities.js";
import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

/** @import { Course } from "../physics/course.js" */

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

const STATES = 128; // of a nutation: the mean of what is periodic and smooth has converged
/** The mean upward force of the pivot of a motion, for the last mass. @type {WeakMap<Course, [mass: number, mean: number | null]>} */
const means = new WeakMap();

/** The mean upward force in a nutation; null if that never ends. @param {Course} course @param {number} mass */
const findMean = (course, mass) => {
  const known = means.get(course);
  if (known?.[0] === mass) return known[1];
  const period = course.motion.nutation_period * NANO;
  const times = Array.from({ length: STATES }, (_, k) => Math.round((k * period) / STATES));
  const find = (/** @type {number} */ time) =>
    findPivotForce(course.top, course.at(time), mass, course.weighed.gravity).upward;
  const mean = Number.isFinite(period)
    ? times.reduce((sum, time) => sum + find(time), 0) / STATES
    : null;
  means.set(course, [mass, mean]);
  return mean;
};

let shown = ""; // a table that stays as it is can be read, and its text marked

/**
 * omega_z, which gravity does not change, and how often the mean phi' is of it: a plate that is thrown up
 * wobbles twice in the time of one such turn.
 * @param {import("../run/telling.js").Sample} sample
 */
const listSpin = ({ state, course }) => {
  const rate = state.omega[2];
  const mean =
    course.isDriven || course.clamped ? NaN : course.free.motion.rates.mean_precession_rate;
  const times = mean / rate;
  const compared = Number.isFinite(times) ? phrase("table.times", { times }) : "";
  return [phrase("table.omega_z"), `${shorten(rate, 6)} rad/s ${compared}`.trim()];
};

/**
 * The force of the pivot, where nothing but the weight of a body of known mass acts.
 * @param {import("../run/telling.js").Sample} sample
 * @param {number} assumed mass in kg, where none is known
 */
const listForce = ({ state, course }, assumed) => {
  const { top, clamped, isDriven, weighed } = course;
  const mass = weighed.mass || assumed;
  if (!Number.isFinite(mass) || clamped || isDriven) return [];
  const { size, upward } = findPivotForce(top, state, mass, weighed.gravity);
  const text = phrase("table.newtons", { size: shorten(size), upward: shorten(upward) });
  const rows = [[phrase("table.pivot_force", { mass: shorten(mass, 3) }), text]];
  const mean = findMean(course, mass);
  if (mean === null) return rows;
  const weight = shorten(mass * weighed.gravity);
  rows.push([phrase("table.mean_force"), phrase("table.weighs", { mean: shorten(mean), weight })]);
  return rows;
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
  const others = [...listForce(sample, mass), listSpin(sample)];
  const all = /** @type {[string, string][]} */ ([...rates, ...others, ...rows]);
  if (JSON.stringify(all) === shown) return;
  shown = JSON.stringify(all);
  find("constants").replaceChildren(make("tbody", {}, ...all.map(createRow)));
};
