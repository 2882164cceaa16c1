// Motions of a top with Ix = Iz = 1, many at once: a record of the axis shows no moment.

import { NO_FRICTION, room } from "../physics/kernel.js";

/** @import { Kernel, Quaternion, Vector } from "../physics/kernel.js" */
/**
 * A motion by Mgl/Ix, the attitude at the start, and wx, wy and p_psi/Ix.
 * @typedef {{weight: number, q: number[], omega: number[]}} Thrown
 */

/** @param {Thrown} thrown the numbers of symtop_start */
const packThrown = ({ weight, q, omega }) => [
  ...[1, 1, weight, ...q, ...omega],
  ...NO_FRICTION,
  ...[0, 0, 0],
];

/** @param {number[]} a @param {number[]} b @returns {Quaternion} */
export const compose = ([w, x, y, z], [a, b, c, d]) => [
  w * a - x * b - y * c - z * d,
  w * b + x * a + y * d - z * c,
  w * c - x * d + y * a + z * b,
  w * d + x * c - y * b + z * a,
];

/** The attitude phi, theta, with psi = 0. @param {number} phi @param {number} theta */
export const point = (phi, theta) => {
  const [a, b] = [phi / 2, theta / 2];
  return compose([Math.cos(a), 0, 0, Math.sin(a)], [Math.cos(b), Math.sin(b), 0, 0]);
};

/** @param {ArrayLike<number>} q @param {number} place @param {Float64Array | number[]} axes @param {number} to */
const writeAxis = (q, place, axes, to) => {
  const [w, x, y, z] = [q[place], q[place + 1], q[place + 2], q[place + 3]];
  axes[to] = 2 * (x * z + w * y);
  axes[to + 1] = 2 * (y * z - w * x);
  axes[to + 2] = 1 - 2 * (x * x + y * y);
};

/** The axis of an attitude. @param {number[]} q @returns {Vector} */
export const findAxis = (q) => {
  /** @type {Vector} */
  const axis = [0, 0, 0];
  writeAxis(q, 0, axis, 0);
  return axis;
};

/** The vertical in the body. @param {number[]} q @returns {Vector} */
export const findVertical = ([w, x, y, z]) => [
  2 * (x * z - w * y),
  2 * (y * z + w * x),
  1 - 2 * (x * x + y * y),
];

export class Many {
  /** @param {Kernel} kernel */
  constructor(kernel) {
    this.kernel = kernel;
  }

  /**
   * The axes of motions at some times, one array for each; null of a motion that is none.
   * @param {Thrown[]} motions @param {Float64Array} times @returns {(Float64Array | null)[]}
   */
  findAxes(motions, times) {
    const [count, each] = [motions.length, times.length];
    const starts = Float64Array.from(motions.flatMap(packThrown));
    const rooms = [
      room(4 * count * each),
      room(3 * count * each),
      room(Math.ceil((count * each) / 8)),
    ];
    const [q, , bytes] = this.kernel.call("states_of_many", starts, count, times, each, ...rooms);
    const left = new Uint8Array(bytes.buffer);
    return motions.map((_, k) => {
      const first = k * each;
      if (left.subarray(first, first + each).some(Boolean)) return null;
      const axes = new Float64Array(3 * each);
      for (let row = 0; row < each; row += 1) writeAxis(q, 4 * (first + row), axes, 3 * row);
      return axes;
    });
  }

  /** What is the same in every nutation, as in symtop_rates. @param {Thrown} motion */
  findRates(motion) {
    const [handle] = this.kernel.call("new", packThrown(motion), room("handle"));
    const [rates] = this.kernel.call("find_rates", handle, room("rates"));
    this.kernel.exports.symtop_free(handle);
    return rates;
  }

  /** Euler's angles and rates at the start. @param {Thrown} motion */
  findAngles({ q, omega }) {
    const [[phi, theta]] = this.kernel.call("find_angles", q, 1, room(3));
    const [[phi_dot, theta_dot]] = this.kernel.call("find_angle_rates", q, omega, 1, room(3));
    return { phi, theta, phi_dot, theta_dot };
  }
}
