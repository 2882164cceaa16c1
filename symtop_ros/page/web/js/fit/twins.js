// Motions that show the same points: twin of truth/fit/twins.py, of what a camera sees.

import { compose, findAxis, point } from "./many.js";
import { Model } from "./model.js";

/** @import { Many, Thrown } from "./many.js" */
/** @import { Camera } from "./projection.js" */
/** @import { Record } from "./record.js" */
/** @typedef {number[]} Vector */
/** @typedef {{motion: Thrown, camera: Camera}} Seen */

/** @param {Vector} a @param {Vector} b @returns {Vector} */
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];

/** A vector in the world. @param {number[]} q @param {Vector} v @returns {Vector} */
const toWorld = (q, v) => {
  const [w, ...u] = q;
  const twice = cross(u, v).map((each) => 2 * each);
  const more = cross(u, twice);
  return v.map((each, k) => each + w * twice[k] + more[k]);
};

/** A vector in the body. @param {number[]} q @param {Vector} v */
const toBody = ([w, x, y, z], v) => toWorld([w, -x, -y, -z], v);

/** The motion that begins at an axis with a velocity. @param {Thrown} motion @param {Vector} axis @param {Vector} velocity @param {number} p @returns {Thrown} */
const startAxis = ({ weight }, axis, velocity, p) => {
  const theta = Math.atan2(Math.hypot(axis[0], axis[1]), axis[2]);
  const q = point(Math.atan2(axis[0], -axis[1]), theta);
  const [wx, wy] = toBody(q, cross(axis, velocity));
  return { weight, q, omega: [wx, wy, p] };
};

/** @param {Thrown} motion */
const findAxisMotion = ({ q, omega }) => {
  const axis = findAxis(q);
  return { axis, velocity: cross(toWorld(q, omega), axis) };
};

/** What a camera of the other elevation sees at the same place, mirrored in depth. @param {number} elevation */
const mirror = (elevation) => {
  const [sin, cos] = [Math.sin(elevation), Math.cos(elevation)];
  return (/** @type {Vector} */ [x, y, z]) => {
    const [high, near] = [y * sin + z * cos, y * cos - z * sin];
    return [x, -high * sin - near * cos, high * cos - near * sin];
  };
};

/** The motion mirrored in the plane of the picture, and the camera that shows it so. @param {Thrown} motion @param {Camera} camera @returns {Seen} */
export const mirrorView = (motion, camera) => {
  const { axis, velocity } = findAxisMotion(motion);
  const [mirrored, moved] = [axis, velocity].map(mirror(camera.elevation));
  return {
    motion: startAxis(motion, mirrored, moved, -motion.omega[2]),
    camera: { ...camera, elevation: -camera.elevation },
  };
};

/** The motion mirrored left and right, and the camera that shows its picture mirrored. @param {Thrown} motion @param {Camera} camera @returns {Seen} */
export const mirrorPicture = (motion, camera) => {
  const { axis, velocity } = findAxisMotion(motion);
  const over = (/** @type {Vector} */ [x, y, z]) => [-x, y, z];
  const { u, centre } = camera;
  return {
    motion: startAxis(motion, over(axis), over(velocity), -motion.omega[2]),
    camera: {
      ...camera,
      roll: -camera.roll,
      centre: centre && [2 * u - centre[0], centre[1]],
    },
  };
};

/** The motion of the other end of the axis. @param {Thrown} motion @returns {Thrown} */
const takeOtherEnd = ({ weight, q, omega: [wx, wy, p] }) => ({
  weight: -weight,
  q: compose(q, [0, 1, 0, 0]),
  omega: [wx, -wy, -p],
});

/** The motion with the vertical turned over, and the camera that shows it so. @param {Thrown} motion @param {Camera} camera @returns {Seen} */
export const turnCamera = (motion, camera) => {
  const mirrored = mirrorView(motion, camera);
  const roll = camera.roll + Math.PI;
  return {
    motion: takeOtherEnd(mirrored.motion),
    camera: { ...mirrored.camera, roll: roll - 2 * Math.PI * Math.round(roll / (2 * Math.PI)) },
  };
};

/** The motion (pi - theta, -Mgl, -p_psi), which has the same x and y of the axis. @param {Thrown} motion @returns {Thrown} */
export const seeFromAbove = (motion) => {
  const { axis, velocity } = findAxisMotion(motion);
  const over = (/** @type {Vector} */ [x, y, z]) => [x, y, -z];
  const found = startAxis(motion, over(axis), over(velocity), -motion.omega[2]);
  return { ...found, weight: -motion.weight };
};

/**
 * The model about the start of another motion, and its parameters.
 * @param {Many} many @param {Record} record @param {Thrown} motion @param {{[name: string]: number} | Camera} more
 */
export const restate = (many, record, { weight, q, omega: [wx, wy, p] }, more) => {
  const model = new Model(many, record, q);
  return {
    model,
    x: model.fill({
      .../** @type {{[name: string]: number}} */ (more),
      "Mgl/Ix": weight,
      "p_psi/Ix": p,
      wx,
      wy,
    }),
  };
};
