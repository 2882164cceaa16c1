// A fixed camera: twin of truth/fit/camera.py, whose text says what its numbers are.

/**
 * With a centre it looks at this point of the picture, else at the pivot.
 * @typedef {{u: number, v: number, log_scale: number, elevation: number, roll: number, nearness: number,
 *   centre?: readonly [number, number]}} Camera
 */

export const CAMERA = /** @type {const} */ ([
  "u",
  "v",
  "log_scale",
  "elevation",
  "roll",
  "nearness",
]);
const LARGEST = 50; // log_scale; a step along a valley may go beyond any picture

/** @param {number} size */
const findScale = (size) => Math.exp(Math.min(size, LARGEST));

/** Tangents of the angles from the centre to the pivot, and the root of 1 and their squares. @param {Camera} camera */
const findAim = ({ u, v, log_scale, nearness, centre = [u, v] }) => {
  const part = nearness / findScale(log_scale);
  const [a, b] = [part * (u - centre[0]), part * (v - centre[1])];
  return { a, b, q: Math.hypot(1, a, b) };
};

/**
 * Write u and v of each axis.
 * @param {ArrayLike<number>} axes x, y, z of each @param {Camera} camera @param {Float64Array} seen
 */
export const project = (axes, camera, seen) => {
  const [up, out] = [Math.sin(camera.elevation), Math.cos(camera.elevation)];
  const [sin, cos] = [Math.sin(camera.roll), Math.cos(camera.roll)];
  const scale = findScale(camera.log_scale);
  const { a, b, q } = findAim(camera);
  for (let k = 0; 3 * k < axes.length; k += 1) {
    const [right, y, z] = [axes[3 * k], axes[3 * k + 1], axes[3 * k + 2]];
    const high = y * up + z * out;
    const part = 1 / (1 - camera.nearness * (z * up - y * out));
    const [s, t] = [part * (cos * right - sin * high), part * (sin * right + cos * high)];
    const along = s * a + t * b;
    const size = scale / (1 - camera.nearness * along);
    const more = (along * q) / (q + 1);
    seen[2 * k] = camera.u + size * (q * s + more * a);
    seen[2 * k + 1] = camera.v + size * (q * t + more * b);
  }
  return seen;
};

/** A point of the picture as a camera at the same place sees it that looks at the pivot. @param {number[]} point @param {Camera} camera */
export const rectify = ([u, v], camera) => {
  const { a, b, q } = findAim(camera);
  const scale = findScale(camera.log_scale);
  const [s, t] = [(u - camera.u) / scale, (v - camera.v) / scale];
  const along = s * a + t * b;
  const size = scale / (q * q + camera.nearness * along);
  const less = along / (q + 1);
  return [camera.u + size * (q * s - less * a), camera.v + size * (q * t - less * b)];
};
