// Lines of the scene as pieces between points: circles of the unit sphere, and traces.

import { spread } from "../physics/spread.js";

/** @import { Vector } from "../physics/kernel.js" */

/** A point of the sphere. @param {number} theta @param {number} phi @param {number} radius @returns {Vector} */
export const findPoint = (theta, phi, radius = 1) => [
  radius * Math.sin(theta) * Math.sin(phi),
  -radius * Math.sin(theta) * Math.cos(phi),
  radius * Math.cos(theta),
];

/** @param {Vector[]} points @returns {number[]} pieces between neighbours */
export const listPieces = (points) =>
  points.slice(1).flatMap((point, k) => [...points[k], ...point]);

/** The circle of the unit sphere at a tilt. @param {number} theta */
export const listParallel = (theta) =>
  listPieces(spread(0, 2 * Math.PI, 97).map((phi) => findPoint(theta, phi)));

/** Parallels and meridians. @param {boolean} isWhole */
export const listSphere = (isWhole) => {
  const depth = isWhole ? Math.PI : Math.PI / 2;
  const tilts = [2, 4, 6, ...(isWhole ? [8, 10] : [])].map((n) => (n * Math.PI) / 12);
  const meridians = spread(Math.PI / 6, Math.PI, 6).map((phi) =>
    listPieces(spread(-depth, depth, 65).map((tilt) => findPoint(tilt, phi))),
  );
  return [...tilts.flatMap(listParallel), ...meridians.flat()];
};
