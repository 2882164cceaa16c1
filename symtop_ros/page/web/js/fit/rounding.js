// Rounding of values that follows the motion: it is no noise, and all rows may have one error.
//
// Twin of find_rounding and Fit._shifts in truth/fit/refine.py, whose texts have the sources.

import { apply, dot } from "./linear.js";
import { splitColumns, whiten } from "./noise.js";

/** @import { Fit } from "./refine.js" */

const SLIGHT = 1e-3; // part of the errors of rounding, below which they are noise
const PLACES = 16; // of the steps of rounding, from one to the next

/** The part of the errors of rounding of each column that noise leaves. @param {Fit} fit */
const findSizes = ({ model, noise, residuals }) => {
  const { record } = model;
  const columns = splitColumns(residuals, record.width);
  return record.rounding.map((rounding, k) => {
    if (!rounding) return 0;
    const square =
      noise.kept.reduce((sum, row) => sum + columns[k][row] ** 2, 0) / noise.kept.length;
    const left = record.fixed[k] ? 0 : Math.max(square - rounding ** 2, 0);
    const step = Math.sqrt(12) * rounding;
    const stays = Math.exp((-2 * Math.PI ** 2 * left) / step ** 2);
    return stays > SLIGHT ? step * stays : 0;
  });
};

/**
 * Changes of the parameters if a column is rounded, for some places of the steps; none if noise makes the
 * errors noise. @param {Fit} fit @returns {number[][]} a row for each column and place
 */
export const findShifts = (fit) => {
  const sizes = findSizes(fit);
  const { model, noise, residuals, slopes, covariance } = fit;
  const { flat, rounding, width } = model.record;
  const steps = rounding.map((each) => Math.sqrt(12) * each);
  return sizes.flatMap((size, column) => {
    if (!size) return [];
    return Array.from({ length: PLACES }, (_, part) => {
      const errors = new Float64Array(flat.length);
      for (let k = column; k < flat.length; k += width) {
        const place = (flat[k] + residuals[k]) / steps[column] + (part + 0.5) / PLACES;
        errors[k] = size * (Math.round(place) - place);
      }
      const white = whiten(noise, errors);
      return apply(
        covariance,
        slopes.columns.map((each) => dot(each, white)),
      );
    });
  });
};

/** The square of the change of a combination of the parameters, in the mean over the places. @param {number[][]} shifts @param {number[]} slope */
export const sumShifts = (shifts, slope) =>
  shifts.reduce((sum, each) => sum + dot(each, slope) ** 2, 0) / PLACES;
