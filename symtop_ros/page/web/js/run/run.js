// A run in the page: its events, each with the exact doubles from which the motion goes on.
//
// Between two events the motion is computed by the kernel, at any time. So a run is its events, and
// nothing else has to be kept of it. Times are whole nanoseconds, as those of a node.

import { Course, MOST_STEPS, NANO, UNWEIGHED } from "../physics/course.js";
import { demandMass } from "../physics/formulas.js";
import { nameEvent } from "./reader.js";
import { State } from "../physics/state.js";

/** @import { Piece } from "../physics/course.js" */
/** @import { Kernel, Vector, Quaternion, Hold, Pushes } from "../physics/kernel.js" */
/** @typedef {"start" | "kick" | "push" | "clamp" | "unclamp" | "change" | "torque"} Kind */
/**
 * What was asked for: a kick or pushes by the names of ~/kick (`act`), the hold of a kick, null for an
 * angular impulse, and what of the page has made the event, where its motion does not tell. Runs of
 * 0.4.0 and before have it in words (`request`).
 * @typedef {{act?: {[name: string]: any}, hold?: Hold | null, made_by?: Maker,
 *   request?: string}} Asked
 */
/**
 * A scene, Reset, a push of a button, a pull of the ball, or a parameter that was set.
 * @typedef {{kind: string, name?: string, value?: number}} Maker
 */
/**
 * An event as in run.json; its time is in s, and whole nanoseconds.
 * @typedef {{kind: Kind, time: number, top: [number, number, number], orientation: Quaternion,
 *   angular_velocity: Vector, friction: number[], torque: Vector, clamped?: boolean, mass?: number,
 *   gravity?: number} & Asked} EventRecord
 */
/**
 * A course in a run: its times count from `since`, in ns of the run.
 * @typedef {{course: Course, since: number}} Placed
 */
/**
 * An event with its time in ns and its motion, the state just before it, the course that it ended,
 * and the ghost: the run without its last kick. Of pushes also each of them, with its number.
 * @typedef {{kind: Kind, time: number, asked: Asked, course: Course, before: State | null,
 *   last: Course | null, ghost: Placed | null, number?: number}} Moment
 */
/**
 * A part of a run, kept for comparison: the state at a time since its start, or nothing after its end.
 * @typedef {(passed: number) => {state: State, course: Course} | null} Kept
 */

// Steps of integration for all events of a run: some ten seconds of a usual processor. A number of
// steps is the same on a busy machine, where a time would refuse what an idle one opens.
const RUN_STEPS = 500_000;
const LEFT_OUT = ["kick", "push", "clamp"]; // by the ghost
const GHOST_STEPS = 3000; // of an integration, for one state of the ghost

export class Run {
  /** @param {Kernel} kernel */
  constructor(kernel) {
    this.kernel = kernel;
    /** @type {Moment[]} */
    this.moments = [];
  }

  /** The last event before a time, or the first one. @param {number} time ns @returns {Moment} */
  findEvent(time) {
    return this.moments[Math.max(0, this.findPlace(time))];
  }

  /** That event; of pushes the last one of them. @param {number} time ns @returns {Moment} */
  find(time) {
    const event = this.findEvent(time);
    return event.course.pushes ? nameMoment(event, event.course.pieceAt(time - event.time)) : event;
  }

  /** All pushes and kicks from a time to another. @param {number} begin ns @param {number} end ns */
  listKicks(begin, end) {
    const [first, last] = [this.findEvent(begin), this.findPlace(end)];
    const events = this.moments.slice(this.moments.indexOf(first), last + 1);
    const kicks = events.flatMap((event, k) => {
      const until = Math.min(end, (events[k + 1]?.time ?? Infinity) - 1);
      return event.course.pushes ? listPushes(event, until) : [event];
    });
    return kicks.filter(({ before, time }) => before && time >= begin);
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
    const { course, time: since } = this.findEvent(time);
    return course.at(time - since);
  }

  /**
   * The state of the ghost; null if there is none, or it is not integrated so far.
   * @param {number} time ns
   */
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
    const ghost = last ? this.findNextGhost(kind, time, course, last) : null;
    this.moments.length = this.findPlace(time) + 1;
    this.release(time);
    this.moments.push({ kind, time, asked, course, before, last: last?.course ?? null, ghost });
  }

  /** End the pushes of the last event at a time in ns. @param {number} time */
  release(time) {
    const event = this.moments.at(-1);
    const pushes = event?.course.pushes;
    if (!event || !pushes) return;
    const { number } = event.course.pieceAt(time - event.time);
    const course = event.course.endPushes(pushes, number);
    const asked = { ...event.asked, act: { ...event.asked.act, number } };
    this.moments[this.moments.length - 1] = { ...event, course, asked };
  }

  /**
   * @param {Kind} kind
   * @param {number} time ns
   * @param {Course} course
   * @param {Moment} last
   * @returns {Placed | null}
   */
  findNextGhost(kind, time, course, last) {
    if (LEFT_OUT.includes(kind)) return { course: last.course, since: last.time };
    const state = this.findGhost(time);
    if (!last.ghost || !state) return null;
    const { top, friction, torque } = course;
    return { course: last.ghost.course.continue(state, { top, friction, torque }), since: time };
  }

  /** What the ghost of a time was spared: a kick, pushes or a clamp. @param {number} time ns */
  findSpared(time) {
    const isSpared = (/** @type {Moment} */ each) => LEFT_OUT.includes(each.kind);
    return this.moments.findLast((each) => each.time <= time && isSpared(each))?.kind ?? null;
  }

  copy() {
    const copy = new Run(this.kernel);
    copy.moments = [...this.moments];
    return copy;
  }

  /** The run from its last start to a time, whatever becomes of it. @param {number} end ns @returns {Kept} */
  keep(end) {
    const start = this.findStart(end);
    const copy = this.copy();
    return (passed) => {
      const time = start + passed;
      return time > end ? null : { state: copy.at(time), course: copy.find(time).course };
    };
  }

  /** The events as in run.json. @returns {EventRecord[]} */
  get records() {
    return this.moments.map(({ kind, time, asked, course }) => {
      const { top, start, friction, torque, clamped, weighed } = course;
      return {
        kind,
        time: time / NANO,
        top: /** @type {Vector} */ ([top.Ix, top.Iz, top.Mgl]),
        orientation: start.given,
        angular_velocity: start.omega,
        friction,
        torque,
        ...(clamped ? { clamped } : {}),
        ...listWeighed(weighed),
        ...asked,
      };
    });
  }

  /** Take over other events, if all are computed. @param {EventRecord[]} events */
  load(events) {
    const read = new Run(this.kernel);
    let left = RUN_STEPS;
    events.forEach((event, place) => {
      left = nameEvent(place, () => read.reach(event.time * NANO, left));
      if (left < 0)
        throw new RangeError(`a run must take at most ${RUN_STEPS} steps, got to event ${place}`);
      nameEvent(place, () => read.append(event));
    });
    this.moments = read.moments;
  }

  /**
   * Integrate the last motion up to a time, as far as the page that made the run did; returns how many
   * of the steps are left, negative if they do not suffice.
   * @param {number} time ns @param {number} steps
   */
  reach(time, steps) {
    const { course, time: since } = this.moments.at(-1) ?? { course: null, time: 0 };
    const passed = Math.round(time) - since;
    let left = steps;
    while (course?.isDriven && course.reach(passed, MOST_STEPS) < passed) {
      left -= MOST_STEPS;
      if (left < 0) break;
    }
    return left;
  }

  /** @param {EventRecord} event */
  append({ kind, time, top, orientation, angular_velocity, friction, torque, ...others }) {
    const { clamped, mass = UNWEIGHED.mass, gravity = UNWEIGHED.gravity, ...asked } = others;
    const [Ix, Iz, Mgl] = top;
    const start = new State(this.kernel, orientation, angular_velocity);
    const weighed = { mass, gravity };
    demandMass({ Ix, Iz, Mgl }, weighed);
    const pushes = kind === "push" && asked.act ? readPushes(asked.act) : null;
    const body = { Ix, Iz, Mgl };
    const course = new Course(this.kernel, body, start, friction, torque, pushes, clamped, weighed);
    course.demandPushes();
    this.add(kind, Math.round(time * NANO), course, asked);
  }
}

/** @param {import("../physics/course.js").Weighed} weighed */
export const isOfKnownWeight = (weighed) => Object.keys(listWeighed(weighed)).length > 0;

/** What is not that of a body that is not weighed. @param {import("../physics/course.js").Weighed} weighed */
const listWeighed = ({ mass, gravity }) => ({
  ...(mass === UNWEIGHED.mass ? {} : { mass }),
  ...(gravity === UNWEIGHED.gravity ? {} : { gravity }),
});

/** The pushes that the fields of ~/kick ask for. @param {{[name: string]: any}} act @returns {Pushes} */
export const readPushes = ({ axle_impulse: impulse, rate, number }) => ({ impulse, rate, number });

/** One of the pushes of an event. @param {Moment} event @param {Piece} piece @returns {Moment} */
const nameMoment = (event, piece) => {
  const { course, begin, number } = piece;
  const before = number > 1 ? event.course.findStateBefore(piece) : event.before;
  return { ...event, time: event.time + begin, course, before, number };
};

/** The pushes of an event up to a time in ns. @param {Moment} event @param {number} end @returns {Moment[]} */
const listPushes = (event, end) => {
  const found = [];
  let piece = event.course.pieceAt(end - event.time);
  for (; piece.number > 1; piece = event.course.pieceAt(piece.begin - 1))
    found.push(nameMoment(event, piece));
  return [...found, nameMoment(event, piece)].reverse();
};
