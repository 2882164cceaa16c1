// Twin of physics/precession.py: theta'' as a quadratic of phi', and the regular precession rates.

import { Big, EXTENDED, LONGEST } from "./big.js";
import { cosineAndSine } from "./elementary.js";

/** @typedef {{Ix: number, Iz: number, Mgl: number}} Top */
/** @typedef {import("./kicks.js").Hold} Hold */

const EPS = 2 ** -52;
export const START_ROUNDING = 64 * EPS;
const COSINE_TERMS = 120; // powers of its series, for tilts of a turn at most

/**
 * The part of theta'' that depends on phi': (a phi' - b) phi' + Mgl, in extended precision.
 */
export class TiltQuadratic {
  /**
   * @param {Top} top
   * @param {number} cosine
   * @param {number} spin psi', or omega_z if the axial momentum is held
   * @param {Hold} hold
   */
  constructor({ Ix, Iz, Mgl }, cosine, spin, hold = "spin_rate") {
    const transverse = hold === "spin_momentum" ? Ix : Ix - Iz;
    this.a = Big.of(transverse, EXTENDED).times(Math.abs(cosine) <= EPS ? 0 : cosine);
    this.b = Big.of(Iz, EXTENDED).times(spin);
    this.Mgl = Mgl;
  }

  /** @param {number} rate */
  at(rate) {
    return this.a.times(rate).minus(this.b).times(rate).plus(this.Mgl);
  }

  /**
   * How it changes from one rate to another, without the cancellation of equal terms.
   * @param {number} before
   * @param {number} after
   */
  change(before, after) {
    const slope = this.a.times(before + after).minus(this.b);
    const largest = this.a.size.times(Math.abs(before) + Math.abs(after)).plus(this.b.size);
    const isZero = !largest.times(START_ROUNDING).isBelow(slope.size);
    return isZero ? 0 : slope.times(after - before).number;
  }

  /** True if it is zero but for rounding of the start. @param {number} rate */
  isBalanced(rate) {
    const size = Math.abs(rate);
    const terms = this.a.size.times(size).plus(this.b.size).times(size).plus(Math.abs(this.Mgl));
    return !terms.times(START_ROUNDING).isBelow(this.at(rate).size);
  }

  get roots() {
    return solveQuadratic(toLong(this.a.number), toLong(this.b.number), toLong(this.Mgl));
  }
}

/** @param {number} x */
const toLong = (x) => Big.of(x, LONGEST);

/**
 * The finite roots of a x^2 - b x + c, the smaller first; two equal ones count twice.
 * @param {Big} a
 * @param {Big} b
 * @param {Big} c
 * @returns {number[]}
 */
const solveQuadratic = (a, b, c) => {
  if (!a.sign) return b.sign ? keepFinite([c.over(b).number]) : [];
  const half = b.times(0.5);
  const discriminant = half.times(half).minus(a.times(c));
  if (discriminant.sign < 0) return [];
  const root = discriminant.root;
  const q = half.sign < 0 ? half.minus(root) : half.plus(root);
  if (!q.sign) return [0, 0];
  const roots = keepFinite([c.over(q).number, q.over(a).number]);
  return roots.sort((first, second) => Math.abs(first) - Math.abs(second));
};

/** @param {number[]} roots */
const keepFinite = (roots) => roots.filter(Number.isFinite);

/** The cosine of a double, with all the digits of long numbers. @param {number} theta */
const findLongCosine = (theta) => {
  const square = toLong(theta).times(theta);
  let term = toLong(1);
  let sum = term;
  for (let n = 2; n <= COSINE_TERMS; n += 2) {
    term = term.times(square).over(-n * (n - 1));
    sum = sum.plus(term);
  }
  return sum;
};

/**
 * The rates phi' of regular precession at a tilt and a spin: two, one or none; the slow one first.
 * @param {Top} top
 * @param {number} theta
 * @param {number} spin psi'
 */
export const findRegularRates = ({ Ix, Iz, Mgl }, theta, spin) => {
  const isHorizontal = Math.abs(cosineAndSine(theta)[0]) <= EPS;
  const cosine = isHorizontal ? toLong(0) : findLongCosine(theta);
  const transverse = toLong(Ix).minus(Iz);
  return solveQuadratic(transverse.times(cosine), toLong(Iz).times(spin), toLong(Mgl));
};

/**
 * The same as exact as a picture needs: long numbers take longer than all other parts of a frame.
 * @param {Top} top
 * @param {number} theta
 * @param {number} spin psi'
 */
export const estimateRoots = ({ Ix, Iz, Mgl }, theta, spin) => {
  const [a, b] = [(Ix - Iz) * Math.cos(theta), Iz * spin];
  const inner = Math.sqrt(b * b - 4 * a * Mgl);
  if (Number.isNaN(inner)) return [];
  const far = b < 0 ? b - inner : b + inner; // without cancellation: one is the quotient of the other
  return [far / (2 * a), (2 * Mgl) / far];
};

/**
 * theta'' in rad/s^2.
 * @param {Top} top
 * @param {number} theta
 * @param {number} rate phi'
 * @param {number} spin psi'
 */
export const findTiltAcceleration = ({ Ix, Iz, Mgl }, theta, rate, spin) => {
  const [cosine, sine] = cosineAndSine(theta);
  return (sine / Ix) * (((Ix - Iz) * cosine * rate - Iz * spin) * rate + Mgl);
};

/**
 * The torques about the line of nodes in the precessing frame, in N m.
 * @param {Top} top
 * @param {number} theta
 * @param {number} rate phi'
 * @param {number} spin psi'
 */
export const findFrameTorques = ({ Ix, Iz, Mgl }, theta, rate, spin) => {
  const [cosine, sine] = cosineAndSine(theta);
  const gravity = Mgl * sine;
  const coriolis = -Iz * spin * rate * sine;
  const centrifugal = (Ix - Iz) * (rate * rate) * sine * cosine;
  return { gravity, coriolis, centrifugal, total: gravity + coriolis + centrifugal };
};
