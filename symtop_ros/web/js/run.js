// A run in the page: its events, each with the exact doubles from which the motion goes on.
//
// Between two events the motion is computed by the kernel, at any time. So a run is its events, and
// nothing else has to be kept of it.

import { State } from "./state.js";

/** @typedef {import("./kernel.js").Kernel} Kernel */
/** @typedef {import("./kernel.js").Motion} Motion */
/** @typedef {import("./precession.js").Top} Top */
/** @typedef {import("./state.js").Vector} Vector */
/** @typedef {import("./state.js").Quaternion} Quaternion */
/** @typedef {import("./kicks.js").Hold} Hold */
/**
 * What is kept of an event, as in run.json.
 * @typedef {object} EventRecord
 * @property {"start" | "kick" | "change" | "torque"} kind
 * @property {number} time s of the run
 * @property {[number, number, number]} top Ix, Iz, Mgl
 * @property {Quaternion} orientation
 * @property {Vector} angular_velocity
 * @property {[number, number]} friction
 * @property {Vector} torque
 * @property {Hold | null} [hold] of a kick; null for an angular impulse
 * @property {string} [request] what was asked for, in words
 */

const FORMAT = 1;
/** @type {Vector} */
const NO_TORQUE = [0, 0, 0];

/** The motion from a start, with friction and torque. */
export class Course {
  /**
   * @param {Kernel} kernel
   * @param {Top} top
   * @param {State} start
   * @param {[number, number]} friction
   * @param {Vector} torque
   */
  constructor(kernel, top, start, friction = [0, 0], torque = NO_TORQUE) {
    this.kernel = kernel;
    this.top = top;
    this.start = start;
    this.friction = friction;
    this.torque = torque;
    const { given: orientation, omega: angular_velocity } = start;
    /** @type {Motion} */
    this.motion = kernel.motion({ ...top, orientation, angular_velocity, friction, torque });
    this.isDriven = [...friction, ...torque].some((each) => each !== 0);
  }

  /** The motion that would follow under gravity alone. @returns {Course} */
  get free() {
    return this.isDriven ? new Course(this.kernel, this.top, this.start) : this;
  }

  /** @param {number} t s since the start */
  at(t) {
    const [w, x, y, z, ...omega] = this.motion.at(t);
    return new State([w, x, y, z], /** @type {Vector} */ (omega));
  }

  /**
   * The course that goes on from a state, with what is changed.
   * @param {State} start
   * @param {{top?: Top, friction?: [number, number], torque?: Vector}} changes
   */
  continue(start, { top = this.top, friction = this.friction, torque = this.torque } = {}) {
    return new Course(this.kernel, top, start, friction, torque);
  }
}

/**
 * A course in a run: its times count from `since`.
 * @typedef {{course: Course, since: number}} Placed
 */
/**
 * An event with its motion, the state just before it, the course that it ended, and the ghost: the
 * run without its last kick.
 * @typedef {{record: EventRecord, course: Course, before: State | null, last: Course | null,
 *   ghost: Placed | null}} Moment
 */

export class Run {
  /** @param {Kernel} kernel */
  constructor(kernel) {
    this.kernel = kernel;
    /** @type {Moment[]} */
    this.moments = [];
  }

  /**
   * The last event before a time, or the first one.
   * @param {number} time
   * @returns {Moment}
   */
  find(time) {
    return this.moments[Math.max(0, this.findPlace(time))];
  }

  /** @param {number} time */
  findPlace(time) {
    return this.moments.findLastIndex(({ record }) => record.time <= time);
  }

  /** The time of the last start before a time. @param {number} time */
  findStart(time) {
    const isStart = (/** @type {Moment} */ { record }) => record.kind === "start" && record.time <= time;
    return this.moments.findLast(isStart)?.record.time ?? 0;
  }

  /** @param {number} time of the run */
  at(time) {
    const { course, record } = this.find(time);
    return course.at(time - record.time);
  }

  /** The state of the ghost, or null. @param {number} time */
  findGhost(time) {
    const { ghost } = this.find(time);
    return ghost ? ghost.course.at(time - ghost.since) : null;
  }

  /**
   * Add an event; what came after its time is no longer part of the run.
   * @param {EventRecord["kind"]} kind
   * @param {number} time
   * @param {Course} course
   * @param {{hold?: Hold | null, request?: string}} more
   */
  add(kind, time, course, more = {}) {
    const last = this.moments.length ? this.find(time) : null;
    const before = last && kind !== "start" ? this.at(time) : null;
    const ghost = last && kind !== "start" ? this.findNextGhost(kind, time, course, last) : null;
    this.moments.length = this.findPlace(time) + 1;
    const { top, start, friction, torque } = course;
    /** @type {EventRecord} */
    const record = {
      kind, time, top: [top.Ix, top.Iz, top.Mgl], orientation: start.given,
      angular_velocity: start.omega, friction, torque, ...more,
    };
    this.moments.push({ record, course, before, last: last?.course ?? null, ghost });
  }

  /**
   * @param {EventRecord["kind"]} kind
   * @param {number} time
   * @param {Course} course
   * @param {Moment} last
   * @returns {Placed | null}
   */
  findNextGhost(kind, time, course, last) {
    if (kind === "kick") return { course: last.course, since: last.record.time };
    if (!last.ghost) return null;
    const { top, friction, torque } = course;
    const state = last.ghost.course.at(time - last.ghost.since);
    return { course: last.ghost.course.continue(state, { top, friction, torque }), since: time };
  }

  /** What run.json holds. */
  get json() {
    return { format: FORMAT, events: this.moments.map(({ record }) => record) };
  }

  /**
   * Take over a run of run.json.
   * @param {{format: number, events: EventRecord[]}} json
   */
  load({ format, events }) {
    if (format !== FORMAT || !Array.isArray(events) || !events.length) {
      throw new RangeError(`a run must have format ${FORMAT} and some events`);
    }
    this.moments = [];
    for (const { kind, time, top: [Ix, Iz, Mgl], orientation, angular_velocity, friction, torque, ...more } of events) {
      const start = new State(orientation, angular_velocity);
      this.add(kind, time, new Course(this.kernel, { Ix, Iz, Mgl }, start, friction, torque), more);
    }
  }
}
