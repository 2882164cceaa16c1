// A motion from a start, with friction, torque and pushes, computed by the kernel at any time.

import { GRAVITY, NO_FRICTION, pack } from "./kernel.js";
import { NAMES } from "./records.js";
import { State } from "./state.js";

/** @import { Kernel, Pushes, Top, Vector } from "./kernel.js" */
/** What moves since a push: its time in ns, and the number of pushes. @typedef {{course: Course, begin: number, number: number}} Piece */

/**
 * Of the body: its mass in kg, 0 if it is not known, and gravity in m/s^2. The motion does not depend on
 * them, the force of the pivot does.
 * @typedef {{mass: number, gravity: number}} Weighed
 */
/** @type {Weighed} */
export const UNWEIGHED = { mass: 0, gravity: GRAVITY };
export const NANO = 1e9; // ns in a second
export const MOST_STEPS = 100_000; // of an integration, for one state: some seconds

export class Course {
  /**
   * @param {Kernel} kernel
   * @param {Top} top
   * @param {State} start
   * @param {number[]} friction coefficients, in the order of symtop_friction_kind
   * @param {Vector} torque
   * @param {Pushes | null} pushes of which the first leaves the start
   * @param {boolean} clamped a hand holds phi
   * @param {Weighed} weighed
   */
  constructor(
    kernel,
    top,
    start,
    friction = NO_FRICTION,
    torque = [0, 0, 0],
    pushes = null,
    clamped = false,
    weighed = UNWEIGHED,
  ) {
    this.kernel = kernel;
    this.top = top;
    this.start = start;
    this.friction = friction;
    this.torque = torque;
    this.pushes = pushes;
    this.clamped = clamped;
    this.weighed = weighed;
    const given = { orientation: start.given, angular_velocity: start.omega, friction, torque };
    /** The numbers of the motion, as the kernel takes them. */
    this.packed = pack({ ...top, ...given });
    this.motion = kernel.motion({ ...top, ...given, pushes, clamped });
    this.isDriven = [...friction, ...torque].some((each) => each !== 0);
    /** @type {Course | null} */
    this.undriven = this.isDriven || pushes ? null : this;
    /** Those that were asked for, by the number of pushes. @type {Map<number, Piece>} */
    this.pieces = new Map();
  }

  /** What moves at a time since the start in whole ns. @param {number} passed @returns {Piece} */
  pieceAt(passed) {
    if (!this.pushes) return { course: this, begin: 0, number: 0 };
    if (this.isDriven) this.at(passed);
    const { start, begin, number } = this.motion.findPiece(passed);
    const piece = this.pieces.get(number) ?? { course: this.continuePiece(start), begin, number };
    this.pieces.set(number, piece);
    return piece;
  }

  /** @param {import("./kernel.js").Found} found of symtop_start */
  continuePiece({ orientation, angular_velocity }) {
    return this.continue(new State(this.kernel, orientation, angular_velocity));
  }

  /** The state just before the push with which a piece begins, but for the first. @param {Piece} piece */
  findStateBefore({ begin }) {
    const former = this.pieceAt(begin - 1);
    return former.course.at(begin - former.begin);
  }

  /** Refuse pushes of which one cannot be; those of a driven motion are tried when it has come there. */
  demandPushes() {
    if (!this.pushes || this.isDriven) return;
    this.pieceAt(Math.ceil((this.pushes.number / this.pushes.rate) * NANO));
  }

  /** The course that gets only so many of its pushes. @param {Pushes} pushes @param {number} number */
  endPushes(pushes, number) {
    const { kernel, top, start, friction, torque, weighed } = this;
    const left = { ...pushes, number };
    const ended = new Course(kernel, top, start, friction, torque, left, false, weighed);
    ended.pieces = this.pieces;
    return ended;
  }

  /** The motion that would follow under gravity alone. @returns {Course} */
  get free() {
    this.undriven ??= this.continueFree(this.start);
    return this.undriven;
  }

  /** @param {number} passed whole ns since the start */
  at(passed) {
    if (this.isDriven && this.reach(passed, MOST_STEPS) < passed) {
      const most = `within ${MOST_STEPS} steps of integration`;
      throw new RangeError(`a time must be ${most}, got ${passed / NANO} s after its event`);
    }
    const [orientation, omega] = this.motion.atNanosecond(passed);
    return new State(this.kernel, orientation, omega);
  }

  /**
   * Integrate towards a time in so many steps; returns the time in ns up to which states are known.
   * @param {number} passed ns since the start @param {number} steps
   */
  reach(passed, steps) {
    const reached = this.motion.reach(passed / NANO, steps);
    return reached < passed / NANO ? Math.floor(reached * NANO) : passed;
  }

  /**
   * The course that goes on from a state, with what is changed; nothing pushes or holds it else.
   * @param {State} start
   * @param {{top?: Top, friction?: number[], torque?: Vector, pushes?: Pushes | null,
   *   clamped?: boolean, weighed?: Weighed}} changes
   */
  continue(start, changes = {}) {
    const { top = this.top, friction = this.friction, torque = this.torque } = changes;
    const { pushes, clamped, weighed = this.weighed } = changes;
    return new Course(this.kernel, top, start, friction, torque, pushes, clamped, weighed);
  }

  /** The parameters of a top and its friction, by the names of a node. */
  get parameters() {
    const { Ix, Iz, Mgl } = this.top;
    const friction = NAMES.friction_kind.map((name, k) => [`friction.${name}`, this.friction[k]]);
    return { "top.Ix": Ix, "top.Iz": Iz, "top.Mgl": Mgl, ...Object.fromEntries(friction) };
  }

  /** The course from a state under gravity alone. @param {State} start */
  continueFree(start) {
    return new Course(this.kernel, this.top, start);
  }
}
