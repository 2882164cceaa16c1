// Matrices of 16 numbers by columns, as WebGL wants them, and vectors of three.

/** @import { Vector, Quaternion } from "../physics/kernel.js" */

/** @param {Float32Array | number[]} a @param {Float32Array | number[]} b @returns {number[]} their product */
export const multiplyMatrices = (a, b) =>
  Array.from({ length: 16 }, (_, place) => {
    const [row, column] = [place % 4, place - (place % 4)];
    let sum = 0;
    for (let k = 0; k < 4; k += 1) sum += a[row + 4 * k] * b[column + k];
    return sum;
  });

/**
 * The view through a lens.
 * @param {number} angle from the lower to the upper edge, in rad
 * @param {number} aspect width over height
 */
export const createPerspective = (angle, aspect) => {
  const [near, far] = [0.05, 60];
  const scale = 1 / Math.tan(angle / 2);
  const depth = 1 / (near - far);
  return [
    ...[scale / aspect, 0, 0, 0],
    ...[0, scale, 0, 0],
    ...[0, 0, (near + far) * depth, -1],
    ...[0, 0, 2 * near * far * depth, 0],
  ];
};

/** @param {Vector} a @param {Vector} b @returns {Vector} */
export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
/** @param {Vector} a @param {Vector} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Vector} a @param {Vector} b @returns {Vector} */
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {Vector} a @param {number} size @returns {Vector} */
export const scale = (a, size) => [a[0] * size, a[1] * size, a[2] * size];
/** @param {Vector} a @param {Vector} b @returns {Vector} */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/** @param {Vector} a */
export const findSize = (a) => Math.hypot(...a);
/** @param {Vector} a @returns {Vector} */
export const normalize = (a) => scale(a, 1 / (findSize(a) || 1));

/** The view from an eye to a target, with z up. @param {Vector} eye @param {Vector} target */
export const createView = (eye, target) => {
  const back = normalize(subtract(eye, target));
  const right = normalize(cross([0, 0, 1], back));
  const up = cross(back, right);
  const turned = [0, 1, 2].flatMap((k) => [right[k], up[k], back[k], 0]);
  return [...turned, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
};

/**
 * A rotation, a size along each of its axes, and a place.
 * @param {Quaternion} rotation @param {Vector} size @param {Vector} place
 */
export const createPose = ([w, x, y, z], [a, b, c] = [1, 1, 1], place = [0, 0, 0]) => [
  ...[a * (w * w + x * x - y * y - z * z), a * 2 * (x * y + w * z), a * 2 * (x * z - w * y), 0],
  ...[b * 2 * (x * y - w * z), b * (w * w - x * x + y * y - z * z), b * 2 * (y * z + w * x), 0],
  ...[c * 2 * (x * z + w * y), c * 2 * (y * z - w * x), c * (w * w - x * x - y * y + z * z), 0],
  ...[...place, 1],
];

/**
 * The shortest rotation from z to a direction.
 * @param {Vector} direction of length 1 @returns {Quaternion}
 */
export const turnTo = ([x, y, z]) => {
  const half = Math.acos(Math.min(Math.max(z, -1), 1)) / 2;
  const across = Math.hypot(x, y);
  if (!across) return [Math.cos(half), Math.sin(half), 0, 0]; // up, or down, by any way
  const size = Math.sin(half) / across;
  return [Math.cos(half), -size * y, size * x, 0];
};
