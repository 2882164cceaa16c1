// A top that lives in the page: what the page asks for is done here, and what follows is told.

import { holdTorque, perform } from "./acts.js";
import { MOST_STEPS, NANO } from "../physics/course.js";
import { chooseWindow, describe, describeMotion, describeNow } from "../words/facts.js";
import { describeStretches } from "../words/stretch.js";
import { phrase } from "../words/wording.js";
import { nameError } from "./errors.js";
import { recall, remember, rememberRun } from "./memory.js";
import { readRun } from "./reader.js";
import { Run } from "./run.js";
import { State } from "../physics/state.js";

/** @import { Kernel } from "../physics/kernel.js" */
/** @import { Course } from "../physics/course.js" */
/** @typedef {{[name: string]: any}} Message */
/**
 * States at a time of the run, in ns: of the top, of the ghost, and of a run that is kept for
 * comparison, at the same time since its start.
 * @typedef {{time: number, state: State, course: Course, ghost: State | null,
 *   kept: ReturnType<import("./run.js").Kept>}} Sample
 */

const LONGEST_FRAME = 100; // ms that a frame may advance the motion: after a sleep nothing jumps
const SPEED = 0.1; // of real time: nutation is too fast for the eye
const FRAME_STEPS = 3000; // of an integration, for one frame
const POINTS = 240; // of the charts, at most
const TRACE = [240, 960]; // points, the fewest and the most
const NUTATION = 64; // points of the trace in a nutation: its pieces are not seen
const WATCHED = 5; // s in which the first nutation after a kick is shown, at least
const FOLLOW = 250; // ms between two texts of a motion that friction or a torque changes
const MOST_PUSHES = 1000; // of one press, as many as the kernel takes
const CHARTS = 60; // ms between two drawings of the charts: no eye follows numbers faster
const AWAKE = 1000; // ms; left alone for so long, a page in a pause is drawn rarely
const REST = 500; // ms between two of these drawings
const DATA = ["link", "load"]; // acts that name their fields as they are typed
const DONE = ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "keyup", "click"];
const CHANGED = ["input", "change", "drop", "scroll", "toggle", "resize", "hashchange", "focus"];

export class LocalTop {
  /**
   * @param {Kernel} kernel
   * @param {{scenes: import("./links.js").SceneFile[], lesson: any[],
   *   bodies: {[name: string]: import("../physics/kernel.js").Part[]},
   *   layers: {[layer: string]: boolean}, run_fields: import("./reader.js").Table, run?: any}} content
   */
  constructor(kernel, content) {
    this.kernel = kernel;
    this.content = content;
    this.run = new Run(kernel);
    this.time = 0; // ns of the run, whole
    this.end = 0; // ns; the latest time that was reached
    this.window = 1; // s that trace and charts show
    this.points = POINTS; // of the trace
    this.isRunning = true;
    this.isRecording = false; // a node can record
    this.isSlow = false; // slower than chosen
    this.speed = SPEED;
    this.layers = { ...content.layers };
    this.torqueUntil = 0;
    this.pushUntil = 0; // ms, while a button is held
    this.graspUntil = 0; // ms, while a button is held that holds the precession
    this.pushes = MOST_PUSHES; // that a button asks for: it ends them when it is released
    this.stirred = 0; // ms; when something was done last
    this.chartsDue = 0; // ms
    this.textsDue = 0; // ms
    this.toldAt = NaN; // ns; the time of the texts
    /** What would follow under gravity alone, at the last texts. @type {Course | null} */
    this.freeOfTexts = null;
    /** States of the last frame by their times in ns. @type {Map<number, State>} */
    this.states = new Map();
    /** @type {(message: Message) => void} */
    this.tell = () => {};
    /** Draws the state of now and those before it. @type {(state: State, states: State[]) => void} */
    this.draw = () => {};
    /** Called when another motion begins. */
    this.begin = () => {};
    /** Ends a rest. */
    this.stir = () => {};
    /** What Reset starts from. */
    this.initial = { start: State.fromEuler(kernel, { theta: 0 }), clamped: false };
    /** A run for comparison, from a start to an end. @type {import("./run.js").Kept | null} */
    this.kept = null;
  }

  /** Begin, with a page that is told and a function that draws. */
  open() {
    const { run } = this.content;
    const { run: last, speed = SPEED, isRunning = false } = recall();
    perform(this, { act: "scene", name: "hurry_slow" });
    const isKept = Boolean(last) && this.take({ act: "load", run: last });
    if (isKept) Object.assign(this, { speed, isRunning });
    else {
      remember({ run: null });
      if (run) this.take({ act: "load", run });
    }
    rememberRun(this);
    this.present();
  }

  /** Show the top to the page from now on. */
  present() {
    const { scenes, lesson, layers, bodies } = this.content;
    this.tellFacts();
    this.tell({ hello: { scenes, layers, lesson, bodies } });
    this.animate();
  }

  /** Advance and draw with every frame from now on; a page in a pause that is left alone rests. */
  animate() {
    let before = NaN; // the stamp of the first frame may be older than the clock of now
    let timer = 0;
    const ask = () => {
      timer = 0;
      requestAnimationFrame(step);
    };
    const step = (/** @type {number} */ now) => {
      // first: an error in this frame does not end the animation
      if (this.isRunning || now < this.stirred + AWAKE) ask();
      else timer = window.setTimeout(ask, REST);
      const passed = Math.max(now - before, 0) || 0;
      before = now;
      this.advance(passed, now);
    };
    this.stir = () => {
      this.stirred = performance.now();
      if (!timer) return;
      clearTimeout(timer);
      before = NaN; // the time of a rest is none of the motion
      ask();
    };
    for (const name of [...DONE, ...CHANGED]) addEventListener(name, this.stir, { capture: true });
    ask();
  }

  /** @param {number} passed ms @param {number} now ms */
  advance(passed, now) {
    if (this.torqueUntil && now > this.torqueUntil) holdTorque(this, 0);
    if (this.pushUntil && now > this.pushUntil) this.release();
    if (this.graspUntil && now > this.graspUntil) this.letGo();
    if (this.isRunning) this.tryToMove(Math.min(passed, LONGEST_FRAME) / 1000);
    this.show(now);
  }

  /** Move, or wait at the end of what the kernel computes. @param {number} passed s of the clock */
  tryToMove(passed) {
    try {
      this.move(passed);
    } catch (error) {
      this.isRunning = false;
      this.tellFacts();
      this.tell({ refused: nameError(error) });
    }
  }

  /** Slower than chosen in the nutation that follows a kick. @param {number} passed s of the clock */
  move(passed) {
    const { course, time } = this.run.findEvent(this.time);
    const before = this.course;
    const first = this.run.findFirstNutation(this.time);
    const most =
      first && this.time < first.end ? (first.end - first.begin) / NANO / WATCHED : Infinity;
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
    this.pushUntil = 0;
    this.run.release(this.time);
  }

  /** Let go the precession that a button has held. */
  letGo() {
    this.graspUntil = 0;
    if (this.course.clamped) this.take({ act: "clamp" });
  }

  /** Tell what has changed if the time has come to another motion. @param {Course} course before */
  cross(course) {
    if (this.course === course) return;
    this.changed();
    if (this.run.find(this.time).kind === "push") this.tellFacts();
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
    this.changed();
  }

  /** Refuse an event that no run.json could hold; the end of what is held needs one more. */
  demandRoom() {
    const { most } = this.content.run_fields;
    const taken = this.run.findPlace(this.time) + 1;
    if (taken + (this.torqueUntil || this.graspUntil ? 2 : 1) > most)
      throw new RangeError(phrase("refused.most", { most }));
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
    this.tellFacts();
  }

  /** Keep the run for comparison, from its last start to now; or let it go. @param {boolean} kept */
  keep(kept) {
    this.kept = kept ? this.run.keep(this.time) : null;
  }

  /** What holds for the motion of now has changed. */
  changed() {
    const { free } = this.course;
    this.window = chooseWindow(free);
    const wanted = (NUTATION * this.window) / free.motion.nutation_period || 0;
    this.points = Math.min(Math.max(wanted, TRACE[0]), TRACE[1]);
    this.chartsDue = this.textsDue = 0;
    this.freeOfTexts = null;
    this.states.clear();
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

  /** The motion that would follow under gravity alone; friction and torques change it. */
  get free() {
    const { course } = this;
    if (!course.isDriven) return course;
    this.freeOfTexts ??= course.continueFree(this.state);
    return this.freeOfTexts;
  }

  /** Times of the last window in ns, for trace and charts: those of a grid, and now. */
  listTimes() {
    const begin = Math.max(this.run.findStart(this.time), this.time - this.window * NANO);
    const step = Math.max(1, Math.round((this.window * NANO) / this.points));
    const first = Math.ceil(begin / step) * step;
    const count = Math.max(0, Math.ceil((this.time - first) / step));
    return [...Array.from({ length: count }, (_, n) => first + n * step), this.time];
  }

  /**
   * States at times, the last of which is now. Those of the frame before are kept: in a frame a few
   * are new.
   * @param {number[]} times ns
   */
  findStates(times) {
    const before = this.states;
    const past = times.slice(0, -1).map((time) => before.get(time) ?? this.run.at(time));
    this.states = new Map(past.map((state, n) => [times[n], state]));
    return [...past, this.state];
  }

  /** Draw the state of now with its trace, and tell the charts when they are due. @param {number} now ms */
  show(now) {
    const times = this.listTimes();
    const states = this.findStates(times);
    this.tellMotion(now);
    this.draw(states[states.length - 1], states);
    if (now < this.chartsDue) return;
    this.chartsDue = now + CHARTS;
    this.tellSamples(times, states);
  }

  /** Tell the numbers of now, and what follows the motion, when they are due. @param {number} now ms */
  tellMotion(now) {
    if (now < this.textsDue) return;
    this.textsDue = now + FOLLOW;
    const { run, time, state } = this;
    this.tell({ now: describeNow(this.course, state) });
    if (!this.course.isDriven || this.toldAt === time) return;
    this.freeOfTexts = null;
    this.tell({ motion: describeMotion(run, time, this.free) });
    this.toldAt = time;
  }

  /** @param {number} time ns @param {State} state @returns {Sample} */
  sample(time, state) {
    const kept = this.kept?.(time - this.run.findStart(this.time)) ?? null;
    const [{ course }, ghost] = [this.run.find(time), this.run.findGhost(time)];
    return { time, state, course, ghost, kept };
  }

  /** Before and after each kick since a time, at one instant: a curve jumps there. @param {number} begin ns */
  sampleKicks(begin) {
    return this.run
      .listKicks(begin, this.time)
      .flatMap(({ time, before, course: { start } }) => [
        { ...this.sample(time, /** @type {State} */ (before)), ghost: null },
        this.sample(time, start),
      ]);
  }

  /** @param {number[]} times ns @param {State[]} states */
  tellSamples(times, states) {
    const step = Math.ceil(times.length / POINTS);
    const last = times.length - 1;
    const chosen = [...times.keys()].filter((n) => (last - n) % step === 0);
    const samples = [
      ...this.sampleKicks(times[0]),
      ...chosen.map((n) => this.sample(times[n], states[n])),
    ].sort((a, b) => a.time - b.time);
    const stretches = describeStretches(this.run, this.time);
    this.tell({ samples, stretches, end: this.end / NANO, isSlow: this.isSlow });
  }

  tellFacts() {
    this.freeOfTexts = null;
    const { run, time } = this;
    const facts = { ...describe(run, time), ...describeMotion(run, time, this.free) };
    this.toldAt = time;
    const { isRunning: running, speed: factor, isRecording: recording } = this;
    this.tell({ facts: { ...facts, running, factor, recording } });
    this.tell({ now: describeNow(this.course, this.state) });
  }

  /**
   * Do what the page asks for, or tell a refusal and leave everything as it was; returns whether it
   * is done.
   * @param {Message} message
   */
  take(message) {
    const { time, end, initial, isRunning } = this;
    const moments = [...this.run.moments];
    try {
      perform(this, message);
      this.tellFacts();
      this.tell({ granted: true });
      return true;
    } catch (error) {
      Object.assign(this, { time, end, initial, isRunning });
      this.run.moments = moments;
      this.changed();
      this.tell({ refused: nameError(error), isOfData: DATA.includes(message.act) });
      this.tellFacts();
      return false;
    }
  }

  /** What run.json holds. */
  get json() {
    const run = this.run.copy();
    if (this.pushUntil) run.release(this.time);
    const isClamped = run.moments.some(({ course }) => course.clamped);
    const format = this.content.run_fields.formats.at(isClamped ? -1 : -2); // as run_file.py
    return { format, events: run.records, end: this.end / NANO };
  }

  /** @param {any} json of run.json; one that cannot be read leaves all as it is */
  load(json) {
    const { events, end } = readRun(this.content.run_fields, json);
    this.run.load(events);
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
