// A fixed camera: twin of truth/fit/camera.py, whose text says what its numbers are.

/** @typedef {{u: number, v: number, log_scale: number, elevation: number, roll: number, nearness: number}} Camera */

export const CAMERA = /** @type {const} */ ([
  "u",
  "v",
  "log_scale",
  "elevation",
  "roll",
  "nearness",
]);
const LARGEST = 50; // log_scale; a step along a valley may go beyond any picture

/**
 * Write u and v of each axis.
 * @param {ArrayLike<number>} axes x, y, z of each @param {Camera} camera @param {Float64Array} seen
 */
export const project = (axes, camera, seen) => {
  const [up, out] = [Math.sin(camera.elevation), Math.cos(camera.elevation)];
  const [sin, cos] = [Math.sin(camera.roll), Math.cos(camera.roll)];
  const scale = Math.exp(Math.min(camera.log_scale, LARGEST));
  for (let k = 0; 3 * k < axes.length; k += 1) {
    const [right, y, z] = [axes[3 * k], axes[3 * k + 1], axes[3 * k + 2]];
    const high = y * up + z * out;
    const size = scale / (1 - camera.nearness * (z * up - y * out));
    seen[2 * k] = camera.u + size * (cos * right - sin * high);
    seen[2 * k + 1] = camera.v + size * (sin * right + cos * high);
  }
  return seen;
};
