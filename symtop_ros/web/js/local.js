// A top that lives in the page: what the page asks for is done here, and what follows is told.

import { applyImpulse, hurry, setPrecessionRate } from "./kicks.js";
import { chooseWindow, describe } from "./facts.js";
import { Course, Run } from "./run.js";
import { findConstants } from "./potential.js";
import { findRegularRates } from "./precession.js";
import { State } from "./state.js";

/** @typedef {import("./kernel.js").Kernel} Kernel */
/** @typedef {import("./wording.js").Writer} Writer */
/** @typedef {import("./state.js").Vector} Vector */
/** @typedef {import("./kicks.js").Hold} Hold */
/** @typedef {{[name: string]: any}} Message */
/**
 * @typedef {{name: string, title: string, story: string, top: Vector, friction: [number, number],
 *   torque: Vector, orientation: import("./state.js").Quaternion, angular_velocity: Vector}} SceneFile
 */

const PUSH = 1; // rad/s by which a push changes a rate
const PULL = 0.5; // of sqrt(|Mgl|/Ix): change of the rates by a pull of one scene unit
const TORQUE_SHARE = 0.0075; // of |Mgl|: the torque of the buttons
const TORQUE_LASTS = 150; // ms after the last message of a button that is held
const STEPS = 24; // of a nutation
const LONGEST_STEP = 0.05; // s of the motion
const LONGEST_FRAME = 100; // ms that a frame may advance the motion: after a sleep nothing jumps
const SPEED = 0.1; // of real time: nutation is too fast for the eye
const MOST_STEPS = 3000; // of an integration, for one frame
const LIMITS = { "friction.axial": 0, "friction.transverse": 0 };
const CHANGING = new Set(["kick", "push", "torque", "reset", "start", "scene", "set", "restart", "link"]);
const POINTS = 240; // of trace and charts
const UNITS = { energy: "J", L_z: "N m s", "L_z'": "N m s" };
const ANGLES = ["phi", "theta", "psi", "phi_dot", "theta_dot", "psi_dot"];
const TOP_NAMES = /** @type {const} */ (["Ix", "Iz", "Mgl"]);

export class LocalTop {
  /**
   * @param {Kernel} kernel
   * @param {Writer} writer
   * @param {{scenes: SceneFile[], lesson: any[], layers: {[layer: string]: boolean}, run?: any}} content
   */
  constructor(kernel, writer, content) {
    this.kernel = kernel;
    this.writer = writer;
    this.content = content;
    this.run = new Run(kernel);
    this.time = 0; // s of the run
    this.end = 0; // the latest time that was reached
    this.window = 1; // s that trace and charts show
    this.isRunning = true;
    this.speed = SPEED;
    this.layers = { ...content.layers };
    this.torqueUntil = 0;
    /** @type {(message: Message) => void} */
    this.tell = () => {};
    /** Draws the state of now and those before it. @type {(state: State, states: State[]) => void} */
    this.draw = () => {};
    /** Called when another motion begins. */
    this.begin = () => {};
    /** What Reset starts from. */
    this.initial = State.fromEuler({ theta: 0 });
    /** The torque of the scene. @type {Vector} */
    this.steady = [0, 0, 0];
  }

  /** Begin, with a page that is told and a function that draws. */
  open() {
    const { scenes, lesson, layers, run } = this.content;
    this.chooseScene("hurry_slow");
    if (run) this.load(run);
    this.tellFacts();
    this.tell({ hello: { scenes, layers, lesson } });
    let before = performance.now();
    const step = (/** @type {number} */ now) => {
      this.advance(now - before, now);
      before = now;
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /**
   * @param {number} passed ms
   * @param {number} now ms
   */
  advance(passed, now) {
    if (this.torqueUntil && now > this.torqueUntil) this.holdTorque(0);
    if (this.isRunning) {
      const { course, record } = this.run.find(this.time);
      const wanted = this.time + (Math.min(passed, LONGEST_FRAME) / 1000) * this.speed;
      this.time = record.time + course.motion.reach(wanted - record.time, MOST_STEPS);
      this.end = Math.max(this.end, this.time);
      if (this.run.find(this.time).course !== course) this.changed();
    }
    this.show();
  }

  /** Go to a time of the run. @param {number} time */
  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.isRunning = false;
    this.changed();
    this.tellFacts();
  }

  /** What holds for the motion of now has changed. */
  changed() {
    this.window = chooseWindow(this.course.free);
    this.begin();
  }

  /** Times and states of the last window, for trace and charts. */
  sample() {
    const begin = Math.max(this.run.findStart(this.time), this.time - this.window);
    return Array.from({ length: POINTS + 1 }, (_, n) => {
      const t = n === POINTS ? this.time : begin + ((this.time - begin) * n) / POINTS;
      return { t, state: this.run.at(t), ghost: this.run.findGhost(t) };
    });
  }

  /** Tell and draw the state of now. */
  show() {
    const samples = this.sample();
    const { state } = samples[POINTS];
    const constants = findConstants(this.course.top, state);
    const before = findConstants(this.course.top, this.course.start);
    const told = Object.entries(UNITS).map(([name, unit]) => {
      const key = /** @type {keyof typeof UNITS} */ (name);
      return [name, [constants[key], constants[key] - before[key], unit]];
    });
    const series = samples.map(({ t, state: each, ghost }) => {
      const { phi, psi } = each.rates;
      return [t, each.angles.theta, phi, psi, ghost ? ghost.angles.theta : null];
    });
    this.tell({ series, constants: Object.fromEntries(told), time: [this.time, this.end] });
    this.draw(state, samples.map((each) => each.state));
  }

  get course() {
    return this.run.find(this.time).course;
  }

  get state() {
    return this.run.at(this.time);
  }

  tellFacts() {
    const facts = describe(this.run, this.writer, this.time);
    this.tell({ facts: { ...facts, running: this.isRunning, factor: this.speed, recording: false } });
  }

  /**
   * Do what the page asks for; a refusal is told.
   * @param {Message} message
   */
  take(message) {
    try {
      this.act(message);
      this.tell({ granted: true });
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      this.tell({ refused: error.message });
    }
    this.tellFacts();
  }

  /** @param {Message} message */
  act(message) {
    const { act } = message;
    if (CHANGING.has(act)) this.end = this.time; // what came later is no longer part of the run
    if (act === "kick") this.kick(hurry(this.state, message.factor, message.hold), message.hold ?? "spin_rate", `${message.factor > 1 ? "hurried" : "delayed"}: phi' times ${short(message.factor)}`);
    else if (act === "push") this.push(message.way);
    else if (act === "torque") this.holdTorque(message.sign);
    else if (act === "pause") this.isRunning = !this.isRunning;
    else if (act === "run") this.isRunning = true;
    else if (act === "rest") this.isRunning = false;
    else if (act === "step") this.step();
    else if (act === "reset") this.start(this.initial, "started again");
    else if (act === "start") this.startWith(message);
    else if (act === "scene") this.chooseScene(message.name);
    else if (act === "set") this.set(message.name, message.value);
    else if (act === "restart") this.restart(message.entry);
    else if (act === "link") this.followLink(message.link);
    else if (act === "speed") this.speed = message.factor;
    else if (act === "seek") this.seek(message.time);
    else if (act === "load") this.load(message.run);
    else if (act === "show") this.layers[message.layer] = message.shown;
  }

  /**
   * @param {State} after
   * @param {Hold | null} hold
   * @param {string} request
   */
  kick(after, hold, request) {
    this.run.add("kick", this.time, this.course.continue(after), { hold, request });
    this.changed();
  }

  /** @param {string} way */
  push(way) {
    const change = { up: -PUSH, down: PUSH, along: PUSH, back: -PUSH }[way] ?? 0;
    const state = this.state;
    if (way === "along" || way === "back") {
      const rate = state.rates.phi + change;
      this.kick(setPrecessionRate(state, rate, "spin_momentum"), "spin_momentum", `pushed ${way}`);
      return;
    }
    const size = this.course.top.Ix * change;
    const { phi } = state.angles;
    this.impulse([size * Math.cos(phi), size * Math.sin(phi), 0], `pushed ${way}`);
  }

  /**
   * @param {Vector} impulse
   * @param {string} request
   */
  impulse(impulse, request) {
    this.kick(applyImpulse(this.course.top, this.state, impulse), null, request);
    this.tellFacts();
  }

  /**
   * The angular impulse of a pull at the end of the axle, to a point in scene units.
   * @param {Vector} end
   */
  pull(end) {
    const { Ix, Mgl } = this.course.top;
    const [a, b, c] = this.state.toWorld([0, 0, 1]);
    const [x, y, z] = [end[0] - a, end[1] - b, end[2] - c];
    const size = PULL * Ix * (Math.sqrt(Math.abs(Mgl) / Ix) || 1);
    this.impulse([size * (b * z - c * y), size * (c * x - a * z), size * (a * y - b * x)], "pulled by the ball");
  }

  /** @param {number} sign 0 for no torque */
  holdTorque(sign) {
    const { top } = this.course;
    const size = TORQUE_SHARE * (Math.abs(top.Mgl) || top.Ix);
    const [x, y, z] = this.steady;
    /** @type {Vector} */
    const torque = [x, y, z + sign * size];
    this.torqueUntil = sign ? performance.now() + TORQUE_LASTS : 0;
    if (this.course.torque[2] === torque[2]) return;
    this.run.add("torque", this.time, this.course.continue(this.state, { torque }));
    this.tellFacts();
  }

  step() {
    this.isRunning = false;
    const period = this.course.free.motion.nutation_period;
    this.time += Math.min(period / STEPS, LONGEST_STEP);
    this.end = Math.max(this.end, this.time);
  }

  /**
   * @param {State} state
   * @param {string} request
   * @param {{top: import("./precession.js").Top, friction: [number, number]}} changes
   */
  start(state, request, { top, friction } = this.course) {
    const course = new Course(this.kernel, top, state, friction, this.steady);
    this.run.add("start", this.time, course, { request });
    this.initial = state;
    this.changed();
  }

  /** @param {Message} values */
  startWith({ theta, phi_dot = 0, psi_dot, precession }) {
    const tilt = Number(theta);
    if (!(tilt >= 0 && tilt <= Math.PI)) throw new RangeError(`theta must be 0 to pi rad, got ${short(tilt)}`);
    const state = createStart(this.course.top, { theta: tilt, phi_dot, psi_dot }, precession);
    const rate = state.rates.phi;
    this.start(state, `started: theta ${short(tilt)}, phi' ${short(rate)}, psi' ${short(psi_dot)}`);
  }

  /** @param {string} name */
  findScene(name) {
    const { scenes } = this.content;
    const scene = scenes.find((each) => each.name === name);
    if (scene) return scene;
    throw new RangeError(`scene must be one of ${scenes.map((each) => each.name).join(", ")}, got ${name}`);
  }

  /** @param {string} name */
  chooseScene(name) {
    const scene = this.findScene(name);
    this.steady = scene.torque;
    const { top, friction, start } = readScene(scene);
    this.start(start, scene.title, { top, friction });
  }

  /**
   * @param {string} name
   * @param {number} value
   */
  set(name, value) {
    const [group, key] = name.split(".");
    const least = LIMITS[/** @type {keyof typeof LIMITS} */ (name)];
    if (least !== undefined && !(value >= least)) throw new RangeError(`${name} must be >= ${least} N m s, got ${short(value)}`);
    const friction = /** @type {[number, number]} */ ([...this.course.friction]);
    const top = { ...this.course.top };
    if (group === "friction") friction[key === "axial" ? 0 : 1] = value;
    else top[/** @type {"Ix" | "Iz" | "Mgl"} */ (key)] = value;
    const course = this.course.continue(this.state, { top, friction });
    this.run.add("change", this.time, course, { request: `${key} changed to ${short(value)}` });
    this.changed();
  }

  /** @param {number} entry */
  restart(entry) {
    const { course, record } = this.run.moments[entry];
    const { top, friction } = course;
    this.start(course.start, `again from: ${record.request}`, { top, friction });
  }

  /**
   * Start the experiment of a link: a scene, parameters of the top, initial conditions.
   * @param {{[name: string]: string}} link
   */
  followLink({ scene: name, ...texts }) {
    const scene = name === undefined ? null : this.findScene(name);
    const { precession, ...rest } = texts;
    const numbers = Object.fromEntries(Object.entries(rest).map(readNumber));
    if (scene) this.steady = scene.torque;
    const { top: own, friction: given, start } = scene ? readScene(scene) : this.course;
    const top = { ...own };
    for (const each of TOP_NAMES) top[each] = numbers[each] ?? own[each];
    /** @type {[number, number]} */
    const friction = [numbers.axial ?? given[0], numbers.transverse ?? given[1]];
    const isStart = Object.keys(texts).some((each) => ANGLES.includes(each) || each === "precession");
    const state = isStart ? createStart(top, numbers, precession) : start;
    const isScene = scene && !Object.keys(texts).length;
    this.start(state, isScene ? scene.title : "from a link", { top, friction });
  }

  /** @param {any} run of run.json */
  load(run) {
    this.run.load(run);
    this.time = this.end = this.run.moments[this.run.moments.length - 1].record.time;
    this.initial = this.run.moments[0].course.start;
    this.isRunning = false;
    this.changed();
  }

  /** The series of the run as comma-separated values, 200 in a window. */
  get csv() {
    const lines = ["time (s),theta (rad),phi_dot (rad/s),psi_dot (rad/s)"];
    const { moments } = this.run;
    moments.forEach(({ record, course }, k) => {
      const end = moments[k + 1]?.record.time ?? this.time;
      const step = chooseWindow(course.free) / 200;
      for (let t = record.time; t < end; t += step) {
        const state = course.at(t - record.time);
        lines.push([t, state.angles.theta, state.rates.phi, state.rates.psi].join(","));
      }
    });
    return `${lines.join("\n")}\n`;
  }
}

/** @param {number} x */
const short = (x) => String(Number(Number(x).toPrecision(4)));

/** @param {SceneFile} scene */
const readScene = ({ top: [Ix, Iz, Mgl], friction, orientation, angular_velocity }) => ({
  top: { Ix, Iz, Mgl }, friction, start: new State(orientation, angular_velocity),
});

/** @param {[string, string | number]} pair of a link @returns {[string, number]} */
const readNumber = ([name, text]) => {
  if (![...TOP_NAMES, "axial", "transverse", ...ANGLES].includes(name)) {
    throw new RangeError(`name in a link must be one of scene, precession, ${[...TOP_NAMES, "axial", "transverse", ...ANGLES].join(", ")}, got ${name}`);
  }
  const value = String(text).trim() ? Number(text) : NaN;
  if (!Number.isFinite(value)) throw new RangeError(`${name} must be a number, got ${text || "nothing"}`);
  return [name, value];
};

/**
 * A start by Euler's angles and rates; phi' may be that of a regular precession, slow or fast.
 * @param {import("./precession.js").Top} top
 * @param {{[name: string]: number}} numbers
 * @param {string} [precession]
 */
const createStart = (top, numbers, precession) => {
  const { phi = 0, theta = 0, psi = 0, phi_dot = 0, theta_dot = 0, psi_dot = 0 } = numbers;
  let rate = phi_dot;
  if (precession) {
    const roots = findRegularRates(top, theta, psi_dot);
    if (!roots.length) throw new RangeError("spin must be such that a regular precession exists");
    rate = precession === "fast" ? roots[roots.length - 1] : roots[0];
  }
  return State.fromEuler({ phi, theta, psi }, { phi: rate, theta: theta_dot, psi: psi_dot });
};
