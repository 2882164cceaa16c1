// A run in the page: its events, each with the exact doubles from which the motion goes on.
//
// Between two events the motion is computed by the kernel, at any time. So a run is its events, and
// nothing else has to be kept of it. Times are whole nanoseconds, as those of a node.

import { Course, NANO } from "../physics/course.js";
import { nameEvent } from "./reader.js";
import { State } from "../physics/state.js";

/** @import { Kernel, Vector, Quaternion, Hold } from "../physics/kernel.js" */
/** @typedef {"start" | "kick" | "push" | "change" | "torque"} Kind */
/**
 * What was asked for, the same of all pushes of a series: a kick by the names of ~/kick (`act`), the hold of it, null for an angular
 * impulse, and the request in words.
 * @typedef {{act?: {[name: string]: any}, hold?: Hold | null, request?: string}} Asked
 */
/**
 * An event as in run.json; its time is in s, and whole nanoseconds.
 * @typedef {{kind: Kind, time: number, top: [number, number, number], orientation: Quaternion,
 *   angular_velocity: Vector, friction: [number, number], torque: Vector} & Asked} EventRecord
 */
/**
 * A course in a run: its times count from `since`, in ns of the run.
 * @typedef {{course: Course, since: number}} Placed
 */
/**
 * An event with its time in ns and its motion, the state just before it, the course that it ended,
 * and the ghost: the run without its last kick.
 * @typedef {{kind: Kind, time: number, asked: Asked, course: Course, before: State | null,
 *   last: Course | null, ghost: Placed | null}} Moment
 */
/**
 * A part of a run, kept for comparison: the state at a time since its start, or nothing after its end.
 * @typedef {(passed: number) => {state: State, course: Course} | null} Kept
 */

const LONGEST = 10_000; // ms in which the events of a run must be computed
const GHOST_STEPS = 3000; // of an integration, for one state of the ghost
const MOST_PUSHES = 1000; // of a series, as in Python

export class Run {
  /** @param {Kernel} kernel */
  constructor(kernel) {
    this.kernel = kernel;
    /** @type {Moment[]} */
    this.moments = [];
  }

  /** The last event before a time, or the first one. @param {number} time ns @returns {Moment} */
  find(time) {
    return this.moments[Math.max(0, this.findPlace(time))];
  }

  /** @param {number} time ns */
  findPlace(time) {
    return this.moments.findLastIndex((moment) => moment.time <= time);
  }

  /** The last start before a time. @param {number} time ns */
  findLastStart(time) {
    return this.moments.findLast((each) => each.kind === "start" && each.time <= time);
  }

  /** The time in ns of the last start before a time. @param {number} time ns */
  findStart(time) {
    return this.findLastStart(time)?.time ?? 0;
  }

  /** The torque with which the last start before a time began. @param {number} time ns */
  findSteady(time) {
    return (this.findLastStart(time) ?? this.moments[0]).course.torque;
  }

  /** The nutation that follows the last event, if that is a kick, in ns. @param {number} time ns */
  findFirstNutation(time) {
    const { kind, time: begin, course } = this.find(time);
    if (kind !== "kick") return null;
    const period = course.free.motion.nutation_period * NANO;
    return Number.isFinite(period) ? { begin, end: begin + period } : null;
  }

  /** @param {number} time ns */
  at(time) {
    const { course, time: since } = this.find(time);
    return course.at(time - since);
  }

  /** The state of the ghost; null if there is none, or it is not integrated so far. */
  /** @param {number} time ns */
  findGhost(time) {
    const { ghost } = this.find(time);
    if (!ghost) return null;
    const passed = time - ghost.since;
    return ghost.course.reach(passed, GHOST_STEPS) < passed ? null : ghost.course.at(passed);
  }

  /**
   * Add an event, not before the first one; what came after its time is no longer part of the run.
   * @param {Kind} kind @param {number} wanted ns @param {Course} course @param {Asked} asked
   */
  add(kind, wanted, course, asked = {}) {
    const time = Math.max(wanted, this.moments[0]?.time ?? 0);
    const last = this.moments.length && kind !== "start" ? this.find(time) : null;
    const before = last ? this.at(time) : null;
    const isMore = kind === "push" && last?.asked === asked;
    const next = last && !isMore ? this.findNextGhost(kind, time, course, last) : null;
    const ghost = isMore ? last.ghost : next;
    this.moments.length = this.findPlace(time) + 1;
    this.moments.push({ kind, time, asked, course, before, last: last?.course ?? null, ghost });
  }

  /** The pushes of one event. @param {Moment} moment */
  findSeries({ kind, asked }) {
    return kind === "push" ? this.moments.filter((each) => each.asked === asked) : [];
  }

  /** Go on with the pushes at the end of the run. @param {number} until ns @param {number} most */
  pushOn(until, most = MOST_PUSHES) {
    const series = this.findSeries(this.moments[this.moments.length - 1]);
    for (let { length } = series; length > 0 && length < most; length += 1) {
      const [{ time: begin, asked, course }] = series;
      const { rate, axle_impulse } = asked.act ?? {};
      const time = begin + Math.floor((length * NANO) / rate + 0.5);
      if (time > until) return;
      const after = this.at(time).kick(course.top, "axle", [axle_impulse]);
      this.add("push", time, course.continue(after), asked);
    }
  }

  /** The moments that were asked for: of a series of pushes, the first. */
  get events() {
    return this.moments.filter(({ asked }, k) => asked !== this.moments[k - 1]?.asked);
  }

  /**
   * @param {Kind} kind
   * @param {number} time ns
   * @param {Course} course
   * @param {Moment} last
   * @returns {Placed | null}
   */
  findNextGhost(kind, time, course, last) {
    if (kind === "kick" || kind === "push") return { course: last.course, since: last.time };
    const state = this.findGhost(time);
    if (!last.ghost || !state) return null;
    const { top, friction, torque } = course;
    return { course: last.ghost.course.continue(state, { top, friction, torque }), since: time };
  }

  /** The run from its last start to a time, whatever becomes of it. @param {number} end ns @returns {Kept} */
  keep(end) {
    const start = this.findStart(end);
    const copy = new Run(this.kernel);
    copy.moments = [...this.moments];
    return (passed) => {
      const time = start + passed;
      return time > end ? null : { state: copy.at(time), course: copy.find(time).course };
    };
  }

  /** The events as in run.json. @returns {EventRecord[]} */
  get records() {
    return this.events.map((moment) => {
      const { kind, time, asked, course } = moment;
      const { top, start, friction, torque } = course;
      const { length: number } = this.findSeries(moment);
      return {
        kind,
        time: time / NANO,
        top: /** @type {Vector} */ ([top.Ix, top.Iz, top.Mgl]),
        orientation: start.given,
        angular_velocity: start.omega,
        friction,
        torque,
        ...asked,
        ...(number ? { act: { ...asked.act, number } } : {}),
      };
    });
  }

  /** Take over other events, if all are computed. @param {EventRecord[]} events */
  load(events) {
    const read = new Run(this.kernel);
    const end = performance.now() + LONGEST;
    events.forEach((event, place) => {
      nameEvent(place, () => read.append(event));
      if (performance.now() > end)
        throw new RangeError(
          `a run must be computed in ${LONGEST / 1000} s, got to event ${place}`,
        );
    });
    this.moments = read.moments;
  }

  /** @param {EventRecord} event */
  append({ kind, time, top, orientation, angular_velocity, friction, torque, ...asked }) {
    const [Ix, Iz, Mgl] = top;
    const start = new State(this.kernel, orientation, angular_velocity);
    const course = new Course(this.kernel, { Ix, Iz, Mgl }, start, friction, torque);
    this.add(kind, Math.round(time * NANO), course, asked);
    this.pushOn(Infinity, asked.act?.number);
  }
}
