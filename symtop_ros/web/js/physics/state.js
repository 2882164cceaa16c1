// Twin of physics/state.py, of one state: quaternion (w, x, y, z), body to world, and the angular
// velocity in the body frame.

import { arcTangent, cosineAndSine, findLength, roundToInteger } from "./elementary.js";
import { LONG, Big } from "./big.js";

/** @typedef {[number, number, number]} Vector */
/** @typedef {[number, number, number, number]} Quaternion */
/** @typedef {{phi: number, theta: number, psi: number}} Angles */

const EPS = 2 ** -52;
const NORM_ROUNDING = 4 * EPS;
const SMALLEST = 1e-100;

/**
 * @param {number} c
 * @param {number} s
 * @param {number} d
 * @param {number} t
 * @returns {[number, number]} the product of two complex numbers
 */
const multiply = (c, s, d, t) => [c * d - s * t, c * t + s * d];

/**
 * Cosine and sine of (a + b)/2; beyond a turn the rounding of the sum is made good.
 * @param {number} a
 * @param {number} b
 */
const halfSum = (a, b) => {
  const total = a + b;
  const part = total - a;
  const lost = (a - (total - part) + (b - part)) / 2;
  const rest = Math.abs(total) <= 2 * Math.PI ? 0 : lost;
  return multiply(...cosineAndSine(total / 2), ...cosineAndSine(rest));
};

/** @param {number} x */
const flush = (x) => (Math.abs(x) < SMALLEST ? 0 : x);

/** @param {number} angle */
const wrap = (angle) => angle - 2 * Math.PI * roundToInteger(angle / (2 * Math.PI));

export class State {
  /**
   * @param {Quaternion} given of norm 1 to some digits
   * @param {Vector} omega
   */
  constructor(given, omega) {
    this.given = /** @type {Quaternion} */ (given.map(flush));
    this.omega = /** @type {Vector} */ (omega.map(flush));
    const [w, x, y, z] = this.given;
    const norm = Math.sqrt(w * w + z * z + (x * x + y * y));
    const isUnit = Math.abs(norm - 1) <= NORM_ROUNDING;
    /** @type {Quaternion} */
    this.orientation = isUnit ? this.given : [w / norm, x / norm, y / norm, z / norm];
  }

  /**
   * @param {Partial<Angles> & {theta: number}} angles in rad
   * @param {Partial<Angles>} rates in rad/s
   */
  static fromEuler({ phi = 0, theta, psi = 0 }, rates = {}) {
    const [plus, minus] = [halfSum(phi, psi), halfSum(phi, -psi)];
    const [c, s] = cosineAndSine(theta / 2);
    const { phi: phiDot = 0, theta: thetaDot = 0, psi: psiDot = 0 } = rates;
    const [cosine, sine] = cosineAndSine(theta);
    const [d, t] = cosineAndSine(psi);
    return new State(
      [c * plus[0], s * minus[0], s * minus[1], c * plus[1]],
      [
        phiDot * sine * t + thetaDot * d,
        phiDot * sine * d - thetaDot * t,
        phiDot * cosine + psiDot,
      ],
    );
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

  /** @returns {Angles} */
  get angles() {
    const [w, x, y, z] = this.orientation;
    const theta = 2 * arcTangent(findLength(x, y), findLength(w, z));
    const [upper, lower] = [arcTangent(z, w), arcTangent(y, x)];
    if (theta === 0) return { phi: 0, theta, psi: wrap(2 * upper) };
    if (theta === Math.PI) return { phi: 0, theta, psi: wrap(-2 * lower) };
    return { phi: wrap(upper + lower), theta, psi: wrap(upper - lower) };
  }

  /** The rates of Euler's angles; on the vertical phi' counts as 0. @returns {Angles} */
  get rates() {
    const [gx, gy, gz] = this.vertical;
    const [wx, wy, wz] = this.omega;
    const sine = findLength(gx, gy);
    const phi = sine > 0 ? (wx * gx + wy * gy) / sine / sine : 0;
    const theta = sine > 0 ? (wx * gy - wy * gx) / sine : findLength(wx, wy);
    return { phi, theta, psi: wz - phi * gz };
  }

  /**
   * phi' and psi' of the doubles that were given, formed with long numbers.
   * @returns {[number, number]}
   */
  get exactRates() {
    const [w, x, y, z] = this.given.map((each) => Big.of(each, LONG));
    const [wx, wy, wz] = this.omega.map((each) => Big.of(each, LONG));
    const upper = w.times(w).plus(z.times(z));
    const lower = x.times(x).plus(y.times(y));
    const alongX = wx.times(x.times(z).minus(w.times(y)));
    const alongY = wy.times(y.times(z).plus(w.times(x)));
    const along = alongX.plus(alongY);
    const rounding = alongX.size.plus(alongY.size).times(4 * EPS);
    if (!rounding.isBelow(along.size)) return [0, wz.number];
    const phi = along.over(upper).over(lower).times(upper.plus(lower).times(0.5));
    const cosine = upper.minus(lower).over(upper.plus(lower));
    return [phi.number, wz.minus(phi.times(cosine)).number];
  }

  /** @param {Vector} vector in the body frame */
  toWorld(vector) {
    const [w, x, y, z] = this.orientation;
    return rotate(w, x, y, z, vector);
  }

  /** @param {Vector} vector in the world frame */
  toBody(vector) {
    const [w, x, y, z] = this.orientation;
    return rotate(-w, x, y, z, vector);
  }
}

/**
 * A vector rotated by a quaternion.
 * @param {number} w
 * @param {number} x
 * @param {number} y
 * @param {number} z
 * @param {Vector} vector
 * @returns {Vector}
 */
export const rotate = (w, x, y, z, [a, b, c]) => {
  const [t, u, s] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * t + (y * s - z * u), b + w * u + (z * t - x * s), c + w * s + (x * u - y * t)];
};
