// Where a motion that was fitted is in its film, by the camera that was fitted.

import { project } from "../fit/projection.js";
import { NANO } from "../physics/course.js";

/** @import { Camera } from "../fit/projection.js" */
/** @import { LocalTop } from "../run/local.js" */
/** @import { Points } from "../run/marks.js" */
/** @import { Place } from "./clicks.js" */
/** @import { Film } from "./film.js" */

const POINTS = 800; // of the path of the motion over the film

/** Whether points are those of a fit, all or up to an event. @param {Points | null} points @param {Points} own */
export const isSame = (points, own) =>
  points !== null &&
  points.camera?.log_scale === own.camera?.log_scale &&
  points.values[0].every((each, k) => each === own.values[0][k]);

/** Where the motion is in the film. @param {LocalTop} top @param {Points} points @param {Film} film @param {number} time ns @returns {Place} */
export const see = (top, points, film, time) => {
  // the points of a run are those of a camera that looks at the pivot; that of the film does not
  const centre = /** @type {const} */ ([film.width / 2, film.height / 2]);
  const camera = /** @type {Camera} */ ({ nearness: 0, ...points.camera, centre });
  const [u, v] = project(top.run.at(time).toWorld([0, 0, 1]), camera, new Float64Array(2));
  return [u, film.height - v];
};

/** The path of the motion in the film. @param {LocalTop} top @param {Points} points @param {Film} film */
export const tracePath = (top, points, film) => {
  const end = Math.round(points.times[points.times.length - 1] * NANO);
  const last = Math.min(end, top.end);
  return Array.from({ length: POINTS + 1 }, (_, k) =>
    see(top, points, film, Math.round((last * k) / POINTS)),
  );
};
