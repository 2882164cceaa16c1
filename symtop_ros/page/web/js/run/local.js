// A top that lives in the page: its run, the time of now and its pace. What a page asks for is done by
// acts.js; what follows is drawn and told.

import { perform } from "./acts.js";
import { MOST_STEPS, NANO } from "../physics/course.js";
import { phrase } from "../words/wording.js";
import { nameError } from "./errors.js";
import { findScene, OPENING, readScene } from "./links.js";
import { Frames } from "./frames.js";
import { cutPoints, Marks } from "./marks.js";
import { recall, remember, rememberRun } from "./memory.js";
import { readRun } from "./reader.js";
import { isOfKnownWeight, Run } from "./run.js";
import { State } from "../physics/state.js";
import { Telling } from "./telling.js";
import { Trace } from "./trace.js";

/** @import { Kernel } from "../physics/kernel.js" */
/** @import { Course } from "../physics/course.js" */
/** @import { Held, Message } from "./acts.js" */
/** @import { Hello, News } from "./telling.js" */

const LONGEST_FRAME = 100; // ms that a frame may advance the motion: after a sleep nothing jumps
const SPEED = 0.1; // of real time: nutation is too fast for the eye
const FRAME_STEPS = 3000; // of an integration, for one frame
const WATCHED = 5; // s in which the first nutation after a kick is shown, at least
const DATA = ["link", "load"]; // acts that name their fields as they are typed

export class LocalTop {
  /**
   * @param {Kernel} kernel
   * @param {Hello & {run_fields: import("./reader.js").Table, run?: any}} content
   */
  constructor(kernel, content) {
    this.kernel = kernel;
    this.content = content;
    this.run = new Run(kernel);
    this.time = 0; // ns of the run, whole
    this.end = 0; // ns; the latest time that was reached
    this.speed = SPEED;
    this.isSlow = false; // slower than chosen
    this.most = Infinity; // speed, while something is shown
    this.isRunning = true;
    this.isRecording = false; // a node can record
    this.layers = { ...content.layers };
    /** What buttons that are held do. @type {Set<Held>} */
    this.held = new Set();
    this.trace = new Trace(this);
    /** What was measured of the run. @type {import("./marks.js").Points | null} */
    this.points = null;
    this.marks = new Marks(this);
    this.telling = new Telling(this);
    this.frames = new Frames(this);
    /** @type {(news: News) => void} */
    this.tell = () => {};
    /** Draws the state of now and those before it. @type {(state: State, states: State[]) => void} */
    this.draw = () => {};
    /** Called when another motion begins. */
    this.begin = () => {};
    /** What Reset starts from. */
    this.initial = { start: State.fromEuler(kernel, { theta: 0 }), clamped: false };
    /** A run for comparison, from a start to an end. @type {import("./run.js").Kept | null} */
    this.kept = null;
  }

  /** Begin, with a page that is told and a function that draws. */
  open() {
    const { run } = this.content;
    const { run: last, speed = SPEED, isRunning = false } = recall();
    perform(this, { act: "scene", name: OPENING });
    const isKept = Boolean(last) && this.take({ act: "load", run: last });
    if (isKept) Object.assign(this, { speed, isRunning });
    else {
      remember({ run: null });
      if (run) this.take({ act: "load", run });
    }
    rememberRun(this);
    this.present();
  }

  /**
   * What a link without a scene leaves open is as on a page that was just opened, whatever runs now: a
   * link is the whole start. @returns {import("./links.js").Beginning}
   */
  get unnamed() {
    const scene = readScene(this.kernel, findScene(this.content.scenes, OPENING));
    return { ...scene, initial: undefined };
  }

  /** Show the top to the page from now on. */
  present() {
    const { scenes, lesson, layers, bodies } = this.content;
    this.telling.tellFacts();
    this.tell({ hello: { scenes, layers, lesson, bodies } });
    this.frames.begin();
  }

  /** @param {number} passed ms @param {number} now ms */
  advance(passed, now) {
    if (this.isRunning) this.tryToMove(Math.min(passed, LONGEST_FRAME) / 1000);
    this.show(now);
  }

  /** Move, or wait at the end of what the kernel computes. @param {number} passed s of the clock */
  tryToMove(passed) {
    try {
      this.move(passed);
    } catch (error) {
      this.isRunning = false;
      this.telling.tellFacts();
      this.tell({ refused: nameError(error) });
    }
  }

  /** Slower than chosen in the nutation that follows a kick. @param {number} passed s of the clock */
  move(passed) {
    const { course, time } = this.run.findEvent(this.time);
    const before = this.course;
    const first = this.run.findFirstNutation(this.time);
    const isFirst = first && this.time < first.end;
    const most = isFirst ? (first.end - first.begin) / NANO / WATCHED : this.most;
    this.isSlow = most < this.speed;
    const wanted = this.time + Math.round(passed * Math.min(this.speed, most) * NANO);
    const reached = time + course.reach(wanted - time, FRAME_STEPS);
    this.run.at(reached); // refused where the kernel computes no state; then the time stays
    this.time = reached;
    this.end = Math.max(this.end, this.time);
    this.cross(before);
  }

  /** Refuse pushes of which one cannot be. */
  demandPushes() {
    this.run.findEvent(this.time).course.demandPushes();
  }

  /** End the pushes of a button. */
  release() {
    this.run.release(this.time);
  }

  /** Tell what has changed if the time has come to another motion. @param {Course} course before */
  cross(course) {
    if (this.course === course) return;
    this.changed();
    if (this.run.find(this.time).kind === "push") this.telling.tellFacts();
  }

  /**
   * Add an event at the present time.
   * @param {import("./run.js").Kind} kind
   * @param {import("../physics/course.js").Course} course that follows
   * @param {import("./run.js").Asked} asked
   */
  add(kind, course, asked = {}) {
    this.demandRoom();
    this.run.add(kind, this.time, course, asked);
    this.points = cutPoints(this.points, this.time); // the rest was seen of another motion
    this.changed();
  }

  /** Refuse an event that no run.json could hold; the end of what is held needs one more. */
  demandRoom() {
    const { most } = this.content.run_fields;
    const isHeld = this.held.has("torque") || this.held.has("grasp");
    const taken = this.run.findPlace(this.time) + 1;
    if (taken + (isHeld ? 2 : 1) > most) throw new RangeError(phrase("refused.most", { most }));
  }

  /** @param {boolean} isRunning */
  setRunning(isRunning) {
    this.isRunning = isRunning;
  }

  /** @param {number} speed of real time */
  setSpeed(speed) {
    this.speed = speed;
  }

  /** Pause, and advance by a part of a motion. @param {number} length ns */
  step(length) {
    this.isRunning = false;
    this.time += length;
    this.end = Math.max(this.end, this.time);
  }

  /** Go to a time of the run. @param {number} time ns */
  seek(time) {
    this.time = Math.min(Math.max(time, this.run.moments[0].time), this.end);
    this.isRunning = false;
    this.changed();
    this.telling.tellFacts();
  }

  /** Keep the run for comparison, from its last start to now; or let it go. @param {boolean} kept */
  keep(kept) {
    this.kept = kept ? this.run.keep(this.time) : null;
  }

  /** What holds for the motion of now has changed. */
  changed() {
    this.trace.begin(this.course);
    this.marks.begin();
    this.telling.begin();
    this.begin();
  }

  get course() {
    return this.run.find(this.time).course;
  }

  get state() {
    return this.run.at(this.time);
  }

  /** The torque without that of a button. */
  get steady() {
    return this.run.findSteady(this.time);
  }

  /** Draw the state of now with its trace, and tell the charts when they are due. @param {number} now ms */
  show(now) {
    const times = this.trace.listTimes();
    const states = this.trace.findStates(times);
    this.telling.tellMotion(now);
    this.draw(states[states.length - 1], states);
    this.telling.tellSamples(now, times, states);
  }

  /**
   * Do what the page asks for, or tell a refusal and leave everything as it was; returns whether it
   * is done.
   * @param {Message} message
   */
  take(message) {
    const { time, end, initial, isRunning, points } = this;
    const [moments, held] = [[...this.run.moments], new Set(this.held)];
    try {
      perform(this, message);
      this.telling.tellFacts();
      this.tell({ granted: true });
      return true;
    } catch (error) {
      Object.assign(this, { time, end, initial, isRunning, points, held });
      this.run.moments = moments;
      this.changed();
      this.tell({ refused: nameError(error), isOfData: DATA.includes(message.act) });
      this.telling.tellFacts();
      return false;
    }
  }

  /** Only a node can record, whose page has the button. */
  record() {}

  /** What run.json holds. */
  get json() {
    const run = this.run.copy();
    if (this.held.has("press")) run.release(this.time);
    const isClamped = run.moments.some(({ course }) => course.clamped);
    const isWeighed = run.moments.some(({ course }) => isOfKnownWeight(course.weighed));
    const [, plain, clamped, weighed, measured] = this.content.run_fields.formats; // as run_file.py
    const { points } = this;
    const format = points ? measured : isWeighed ? weighed : isClamped ? clamped : plain;
    return { format, events: run.records, end: this.end / NANO, ...(points ? { points } : {}) };
  }

  /** @param {any} json of run.json; one that cannot be read leaves all as it is */
  load(json) {
    const { events, end, points } = readRun(this.content.run_fields, json);
    this.run.load(events);
    this.points = points;
    const wanted = Math.round(Math.max(end, events[events.length - 1].time) * NANO);
    const { time, course } = this.run.findEvent(wanted);
    // What takes too long to integrate is reached later.
    this.time = this.end = time + course.reach(wanted - time, MOST_STEPS);
    const { start, clamped } = this.run.moments[0].course;
    this.initial = { start, clamped };
    this.isRunning = false;
    this.changed();
  }
}
