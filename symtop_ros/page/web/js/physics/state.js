// A state: quaternion (w, x, y, z), body to world, and the angular velocity in the body frame.

import { room } from "./kernel.js";
import { STATUS } from "./records.js";

/** @import { Kernel, Vector, Quaternion, Hold } from "./kernel.js" */
/** @typedef {{phi: number, theta: number, psi: number}} Angles */

export class State {
  /**
   * @param {Kernel} kernel
   * @param {ArrayLike<number>} given quaternion of norm 1 within 0.001; a motion starts from it
   * @param {ArrayLike<number>} omega
   */
  constructor(kernel, given, omega) {
    this.kernel = kernel;
    this.given = /** @type {Quaternion} */ (Array.from(given));
    const taken = kernel.call("normalize", this.given, omega, 1, room(4), room(3));
    const [orientation, rates] = taken.map((part) => [...part]);
    this.orientation = /** @type {Quaternion} */ (orientation);
    this.omega = /** @type {Vector} */ (rates);
    /** @type {{angles?: Angles, rates?: Angles}} */
    this.found = {};
  }

  /**
   * @param {Kernel} kernel
   * @param {Partial<Angles> & {theta: number}} angles in rad
   * @param {Partial<Angles>} rates in rad/s
   */
  static fromEuler(kernel, { phi = 0, theta, psi = 0 }, rates = {}) {
    const given = [[phi, theta, psi], [rates.phi ?? 0, rates.theta ?? 0, rates.psi ?? 0], 1];
    const [orientation, omega] = kernel.call("from_angles", ...given, room(4), room(3), room(1));
    return new State(kernel, orientation, omega);
  }

  /** The vertical in the body frame. @returns {Vector} */
  get vertical() {
    const [w, x, y, z] = this.orientation;
    return [2 * (x * z - w * y), 2 * (y * z + w * x), w * w + z * z - (x * x + y * y)];
  }

  get isVertical() {
    const [x, y] = this.vertical;
    return x === 0 && y === 0;
  }

  /** @param {string} what @param {Vector[]} given @returns {Angles} */
  find(what, ...given) {
    const [[phi, theta, psi]] = this.kernel.call(
      `find_${what}`,
      this.orientation,
      ...given,
      1,
      room(3),
    );
    return { phi, theta, psi };
  }

  get angles() {
    this.found.angles ??= this.find("angles");
    return this.found.angles;
  }

  /** The rates of Euler's angles; on the vertical phi' counts as 0. */
  get rates() {
    this.found.rates ??= this.find("angle_rates", this.omega);
    return this.found.rates;
  }

  /**
   * The state after a kick.
   * @param {import("./kernel.js").Top} top
   * @param {"rate" | "change" | "factor" | "impulse" | "axle"} kind
   * @param {number[]} amount of phi' in rad/s; or N m s, in the world frame or of a push on the axle
   * @param {Hold} hold
   */
  kick(top, kind, amount, hold = "spin_rate") {
    if (this.isVertical && kind !== "impulse") {
      const sentence = this.kernel.describe(STATUS.VERTICAL);
      throw new RangeError(`${sentence}, got theta = ${this.angles.theta < 1 ? 0 : "pi"}`);
    }
    const { kernel, orientation } = this;
    return new State(kernel, orientation, kernel.kick(top, this, kind, amount, hold));
  }

  /** A vector of the body frame in the world frame. @param {Vector} vector @returns {Vector} */
  toWorld([a, b, c]) {
    const [w, x, y, z] = this.orientation;
    const [t, u, s] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
    return [a + w * t + (y * s - z * u), b + w * u + (z * t - x * s), c + w * s + (x * u - y * t)];
  }
}
