// Lines of the scene as pieces between points: circles of the unit sphere, and traces.

/** @import { Vector } from "../physics/kernel.js" */

/** @param {Vector[]} points @returns {number[]} pieces between neighbours */
export const listPieces = (points) =>
  points.slice(1).flatMap((point, k) => [...points[k], ...point]);

/** The circle of the unit sphere at a tilt. @param {number} theta */
export const listParallel = (theta) =>
  listPieces(
    Array.from({ length: 97 }, (_, k) => {
      const angle = (2 * Math.PI * k) / 96;
      return [
        Math.sin(theta) * Math.cos(angle),
        Math.sin(theta) * Math.sin(angle),
        Math.cos(theta),
      ];
    }),
  );

/** Parallels and meridians. @param {boolean} isWhole */
export const listSphere = (isWhole) => {
  const depth = isWhole ? Math.PI : Math.PI / 2;
  const tilts = [2, 4, 6, ...(isWhole ? [8, 10] : [])].map((n) => (n * Math.PI) / 12);
  const meridians = Array.from({ length: 6 }, (_, n) =>
    listPieces(
      Array.from({ length: 65 }, (__, k) => {
        const tilt = depth * (k / 32 - 1);
        const phi = (n * Math.PI) / 6;
        return [Math.sin(tilt) * Math.cos(phi), Math.sin(tilt) * Math.sin(phi), Math.cos(tilt)];
      }),
    ),
  );
  return [...tilts.flatMap(listParallel), ...meridians.flat()];
};
