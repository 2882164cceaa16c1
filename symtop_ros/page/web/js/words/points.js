// What is told of measured points: how many there are, and what the motion leaves of one.

import { nameUnit, toUnit } from "./quantities.js";
import { phrase } from "./wording.js";

/** @typedef {NonNullable<ReturnType<import("../run/marks.js").Marks["describe"]>>} Told */

/** The time of a point and its residuals. @param {Told} told */
export const writePoint = ({ time, left }) => {
  const residuals = left.map(({ name, unit, value }) => ({
    name,
    unit: nameUnit(unit),
    value: unit === "rad" ? toUnit(value) : value,
  }));
  return phrase("pointed", { time, residuals });
};

/** @param {Told | null} told */
export const writePoints = (told) => {
  if (!told) return "";
  const { kind: what, count, rows } = told;
  const thinned = rows > count ? { rows } : null;
  return `${phrase("points", { count, what, thinned })} ${writePoint(told)}`;
};
