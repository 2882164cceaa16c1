// A motion from a start, with friction and torque, computed by the kernel at any time.

import { pack } from "./kernel.js";
import { State } from "./state.js";

/** @import { Kernel, Top, Vector } from "./kernel.js" */

export const NANO = 1e9; // ns in a second
export const MOST_STEPS = 100_000; // of an integration, for one state: some seconds

export class Course {
  /**
   * @param {Kernel} kernel
   * @param {Top} top
   * @param {State} start
   * @param {[number, number]} friction
   * @param {Vector} torque
   */
  constructor(kernel, top, start, friction = [0, 0], torque = [0, 0, 0]) {
    this.kernel = kernel;
    this.top = top;
    this.start = start;
    this.friction = friction;
    this.torque = torque;
    const given = { orientation: start.given, angular_velocity: start.omega, friction, torque };
    /** The numbers of the motion, as the kernel takes them. */
    this.packed = pack({ ...top, ...given });
    this.motion = kernel.motion({ ...top, ...given });
    this.isDriven = [...friction, ...torque].some((each) => each !== 0);
    /** @type {Course | null} */
    this.undriven = this.isDriven ? null : this;
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
   * The course that goes on from a state, with what is changed.
   * @param {State} start @param {{top?: Top, friction?: [number, number], torque?: Vector}} changes
   */
  continue(start, { top = this.top, friction = this.friction, torque = this.torque } = {}) {
    return new Course(this.kernel, top, start, friction, torque);
  }

  /** The parameters of a top and its friction, by the names of a node. */
  get parameters() {
    const { Ix, Iz, Mgl } = this.top;
    const [axial, transverse] = this.friction;
    const friction = { "friction.axial": axial, "friction.transverse": transverse };
    return { "top.Ix": Ix, "top.Iz": Iz, "top.Mgl": Mgl, ...friction };
  }

  /** The course from a state under gravity alone. @param {State} start */
  continueFree(start) {
    return new Course(this.kernel, this.top, start);
  }
}
