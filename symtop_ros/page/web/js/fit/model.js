// The model of a record: what the exact motion of some parameters shows, and its derivatives.
//
// Twin of truth/fit/model.py, for points of the axis without friction.

import { dot } from "./linear.js";
import { compose, findVertical } from "./many.js";
import { CAMERA, project } from "./projection.js";

/** @import { Many, Thrown } from "./many.js" */
/** @import { Camera } from "./projection.js" */
/** @import { Record } from "./record.js" */
/** @typedef {{[name: string]: number}} Named */

export const LENGTH = "log_length"; // of points of an axis; their distance from the pivot is its exp
const MOVING = ["Mgl/Ix", "p_psi/Ix", "turn_1", "turn_2", "wx", "wy"]; // change the motion
// A phase that changes by DELTA has a forward difference that is wrong by DELTA/2 of itself, and a
// central one by DELTA^2/6; the rounding of phases, below 1e-14 rad, adds less than 1e-8 to both.
const [DELTA, CENTRAL_DELTA] = [2e-6, 2e-4];
const LARGEST_STEP = 1e-5; // of the scale of a parameter
const BAD = 1e3; // residual of parameters without a motion
const POLE = 1e-9;

/** Axes of the body about which a reference is turned. @param {number[]} reference */
const findBasis = (reference) => {
  const [x, y] = findVertical(reference);
  const size = Math.hypot(x, y);
  const across = size < POLE ? [1, 0] : [-y / size, x / size];
  return [across, [-across[1], across[0]]];
};

/** A rotation vector across the axis as a quaternion. @param {number} x @param {number} y */
const turn = (x, y) => {
  const angle = Math.hypot(x, y);
  const part = angle ? Math.sin(angle / 2) / angle : 0.5;
  return [Math.cos(angle / 2), part * x, part * y, 0];
};

export class Model {
  /** @param {Many} many @param {Record} record @param {number[]} reference attitude near the start */
  constructor(many, record, reference) {
    this.many = many;
    this.record = record;
    this.reference = reference;
    this.basis = findBasis(reference);
    const camera = CAMERA.filter((each) => each !== "nearness" || record.hasPerspective);
    const others = record.kind === "pixels" ? camera : record.hasLength ? [LENGTH] : [];
    this.names = [...MOVING, ...others];
    this.place = Object.fromEntries(this.names.map((each, k) => [each, k]));
  }

  /** The same model of another part of the record, with the same start. @param {Record} record */
  move(record) {
    return new Model(this.many, record, this.reference);
  }

  /** Parameters of named values; the others are 0. @param {Named} named */
  fill(named) {
    return this.names.map((each) => named[each] ?? 0);
  }

  /** @param {number[]} x @returns {Thrown} */
  read([weight, p, first, second, wx, wy]) {
    const [a, b] = this.basis;
    const small = turn(first * a[0] + second * b[0], first * a[1] + second * b[1]);
    return { weight, q: compose(this.reference, small), omega: [wx, wy, p] };
  }

  /** @param {number[]} x @returns {Camera} */
  findCamera(x) {
    const take = (/** @type {string} */ name) => x[this.place[name]] ?? 0;
    const found = Object.fromEntries(CAMERA.map((name) => [name, take(name)]));
    return /** @type {Camera} */ ({ ...found, centre: this.record.given.centre });
  }

  /** What is shown of axes. @param {Float64Array | null} axes @param {number[]} x */
  see(axes, x) {
    const { kind, hasLength, flat } = this.record;
    if (!axes) return null;
    if (kind === "pixels") return project(axes, this.findCamera(x), new Float64Array(flat.length));
    return hasLength ? axes.map((each) => each * Math.exp(x[this.place[LENGTH]])) : axes;
  }

  /** The differences between what parameters show and the record. @param {number[]} x */
  findResiduals(x) {
    const [axes] = this.many.findAxes([this.read(x)], this.record.times);
    return this.compare(this.see(axes, x));
  }

  /** @param {Float64Array | null} shown */
  compare(shown) {
    const { flat } = this.record;
    return shown ? shown.map((each, k) => each - flat[k]) : new Float64Array(flat.length).fill(BAD);
  }

  /** The size of each parameter: rates are those of the motion. @param {number[]} x */
  findScales(x) {
    const [weight, p, , , wx, wy] = x;
    const rate = Math.sqrt(Math.abs(weight)) + Math.max(...[p, wx, wy].map(Math.abs));
    const size = Math.exp(x[this.place.log_scale] ?? 0);
    /** @type {Named} */
    const sizes = { "Mgl/Ix": Math.max(Math.abs(weight), 0.01 * rate ** 2), u: size, v: size };
    for (const name of ["p_psi/Ix", "wx", "wy"]) sizes[name] = rate;
    return this.names.map((name) => sizes[name] ?? 1);
  }

  /** The largest phase in rad by the end of the record. @param {number[]} x */
  findPhase(x) {
    return this.findScales(x)[this.place.wx] * this.record.seconds;
  }

  /** The derivatives of the residuals, a column for each parameter. @param {number[]} x @param {boolean} central */
  findJacobian(x, central = false) {
    const delta = (central ? CENTRAL_DELTA : DELTA) / this.findPhase(x);
    const steps = this.findScales(x).map((each) => each * Math.min(delta, LARGEST_STEP));
    const shown = this.showAll([x, ...steps.flatMap((step, k) => moveBoth(x, k, step, central))]);
    return steps.map((step, k) => {
      const high = shown[central ? 2 * k + 1 : k + 1];
      const low = central ? shown[2 * k + 2] : shown[0];
      const taken = (central ? 2 : 1) * step;
      return high && low
        ? high.map((each, row) => (each - low[row]) / taken)
        : new Float64Array(this.record.flat.length).fill(Number.NaN);
    });
  }

  /** What parameters show that differ in one number each; a camera does not change the motion. @param {number[][]} all */
  showAll(all) {
    const isMoved = (/** @type {number[]} */ x) => MOVING.some((_, k) => x[k] !== all[0][k]);
    const moved = all.filter((x, k) => k === 0 || isMoved(x));
    const axes = this.many.findAxes(
      moved.map((x) => this.read(x)),
      this.record.times,
    );
    return all.map((x) => this.see(axes[Math.max(moved.indexOf(x), 0)], x));
  }

  /** What is known, as rows: places of parameters, values and deviations. */
  get priors() {
    return Object.entries(this.record.known)
      .filter(([name]) => name in this.place)
      .map(([name, [value, deviation]]) => ({ place: this.place[name], value, deviation }));
  }

  /** The errors of what is known, in deviations. @param {number[]} x */
  findErrors(x) {
    return this.priors.map(({ place, value, deviation }) => (x[place] - value) / deviation);
  }
}

/** @param {number[]} x @param {number} place @param {number} step @param {boolean} both */
const moveBoth = (x, place, step, both) =>
  (both ? [step, -step] : [step]).map((by) => x.map((each, k) => (k === place ? each + by : each)));

/** The square of a sum in which each error counts once. @param {ArrayLike<number>} errors */
export const sumSquares = (errors) => dot(errors, errors);
