// What the page is told of a top, and when: facts after an act, numbers of now, samples for charts.

import { NANO } from "../physics/course.js";
import { describe, describeMotion, describeNow } from "../words/facts.js";
import { describePresent } from "../words/present.js";
import { describeStretches } from "../words/stretch.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Found, Part } from "../physics/kernel.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Facts, MotionFacts, Now } from "../words/facts.js" */
/** @import { SceneFile } from "./links.js" */
/** @import { LocalTop } from "./local.js" */
/** @import { Mark } from "./marks.js" */
/**
 * States at a time of the run, in ns: of the top, of the ghost, and of a run that is kept for
 * comparison, at the same time since its start.
 * @typedef {{time: number, state: State, course: Course, ghost: State | null,
 *   kept: ReturnType<import("./run.js").Kept>}} Sample
 */
/**
 * What a page can offer: scenes, layers and whether each is shown, the lesson, bodies.
 * @typedef {{scenes: SceneFile[], layers: {[layer: string]: boolean},
 *   lesson: import("../controls/lesson.js").Step[], bodies: {[name: string]: Part[]}}} Hello
 */
/**
 * A frame: samples up to now, measured points and what is told of one, what was exchanged, why the axle moves so just now, and the end of the run in
 * s. @typedef {{samples: Sample[], marks: Mark[],
 *   points: ReturnType<import("./marks.js").Marks["describe"]>, stretches: ReturnType<typeof describeStretches>, present: string,
 *   end: number, isSlow: boolean}} Frame
 */
/**
 * One piece of news for the page: what it can offer; what holds after an act, or for the motion alone;
 * the numbers of now; a frame; starts that were solved for; an act that is refused (about data, their
 * names are shown as they were typed) or granted; what a node has said; that it is lost, or null when it
 * is back.
 * @typedef {{hello: Hello} | {facts: Facts} | {motion: MotionFacts} | {now: Now} | Frame |
 *   {solved: Found} | {refused: string, isOfData?: boolean} | {granted: true} | {said: string} |
 *   {lost: string | null}} News
 */

const POINTS = 240; // of the charts, at most
const FOLLOW = 250; // ms between two texts of a motion that friction or a torque changes
const CHARTS = 60; // ms between two drawings of the charts: no eye follows numbers faster

export class Telling {
  /** @param {LocalTop} top */
  constructor(top) {
    this.top = top;
    this.chartsDue = 0; // ms
    this.textsDue = 0; // ms
    this.toldAt = NaN; // ns; the time of the texts
    /** What would follow under gravity alone, at the last texts. @type {Course | null} */
    this.freeOfTexts = null;
  }

  /** All is due: another motion holds. */
  begin() {
    this.chartsDue = this.textsDue = 0;
    this.freeOfTexts = null;
  }

  /** The motion that would follow under gravity alone; friction and torques change it. */
  get free() {
    const { course, state } = this.top;
    if (!course.isDriven) return course;
    this.freeOfTexts ??= course.continueFree(state);
    return this.freeOfTexts;
  }

  tellFacts() {
    this.freeOfTexts = null;
    const { run, time, isRunning: running, speed: factor, isRecording: recording } = this.top;
    const facts = { ...describe(run, time), ...describeMotion(run, time, this.free) };
    this.toldAt = time;
    this.top.tell({ facts: { ...facts, running, factor, recording } });
    this.top.tell({ now: describeNow(this.top.course, this.top.state) });
  }

  /** Tell the numbers of now, and what follows the motion, when they are due. @param {number} now ms */
  tellMotion(now) {
    if (now < this.textsDue) return;
    this.textsDue = now + FOLLOW;
    const { run, time, course, state } = this.top;
    this.top.tell({ now: describeNow(course, state) });
    if (!course.isDriven || this.toldAt === time) return;
    this.freeOfTexts = null;
    this.top.tell({ motion: describeMotion(run, time, this.free) });
    this.toldAt = time;
  }

  /**
   * Tell the samples of the trace, when the charts are due.
   * @param {number} now ms
   * @param {number[]} times ns
   * @param {State[]} states
   */
  tellSamples(now, times, states) {
    if (now < this.chartsDue) return;
    this.chartsDue = now + CHARTS;
    const step = Math.ceil(times.length / POINTS);
    const last = times.length - 1;
    const chosen = [...times.keys()].filter((n) => (last - n) % step === 0);
    const samples = [
      ...this.sampleKicks(times[0]),
      ...chosen.map((n) => this.sample(times[n], states[n])),
    ].sort((a, b) => a.time - b.time);
    const { run, time, end, isSlow, isRunning, course, state } = this.top;
    const isWatched = isSlow || !isRunning; // else the sentence would be gone before it is read
    const present = isWatched ? describePresent(course, state) : "";
    const stretches = describeStretches(run, time);
    const { marks, trace } = this.top;
    const seen = { marks: marks.list(trace.since, time), points: marks.describe() };
    this.top.tell({ samples, ...seen, stretches, present, end: end / NANO, isSlow });
  }

  /** @param {number} time ns @param {State} state @returns {Sample} */
  sample(time, state) {
    const { run, time: now, kept: find } = this.top;
    const kept = find?.(time - run.findStart(now)) ?? null;
    return { time, state, course: run.find(time).course, ghost: run.findGhost(time), kept };
  }

  /** Before and after each kick since a time, at one instant: a curve jumps there. @param {number} begin ns */
  sampleKicks(begin) {
    return this.top.run
      .listKicks(begin, this.top.time)
      .flatMap(({ time, before, course: { start } }) => [
        { ...this.sample(time, /** @type {State} */ (before)), ghost: null },
        this.sample(time, start),
      ]);
  }
}
