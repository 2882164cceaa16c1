// What a page asks of its top: kicks, pushes, torques, starts, and the time of the run.

import { BALANCE, solveBalance } from "../physics/balance.js";
import { Course, NANO, UNWEIGHED } from "../physics/course.js";
import { NAMES } from "../physics/records.js";
import { cross, scale, subtract } from "../scene/matrices.js";
import { readPushes } from "./run.js";
import { phrase } from "../words/wording.js";
import { createStart, describeStart, findScene, readLink, readScene } from "./links.js";

/** @import { LocalTop } from "./local.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Hold, Part, Vector } from "../physics/kernel.js" */
/** @import { Beginning } from "./links.js" */
/**
 * A start by angles in rad and rates in rad/s; phi' may be that of a regular precession.
 * @typedef {{theta: number, psi_dot: number, theta_dot?: number, phi_dot?: number,
 *   precession?: string}} AskedStart
 */
/** @typedef {{axle_impulse?: number, rate?: number, number?: number}} AskedPushes */
/** What a button does while it is held. @typedef {"torque" | "press" | "grasp"} Held */
/**
 * Acts that make an event, each with what it needs: rates and angles in rad, a torque by its sign, the
 * end of a pull in scene units, the place of an event in the run, fields of a link as texts.
 * @typedef {{
 *   body: {parts: Part[]},
 *   clamp: {},
 *   grasp: {},
 *   kick: {factor: number, hold: Hold},
 *   link: {link: {[field: string]: string}},
 *   press: {},
 *   pull: {end: Vector},
 *   push: {way: string},
 *   pushes: AskedPushes,
 *   reset: {},
 *   restart: {entry: number},
 *   scene: {name: string},
 *   set: {name: string, value: number},
 *   start: AskedStart,
 *   tilt: {theta: number, phi: number},
 *   torque: {sign: number},
 * }} EventActs
 */
/**
 * Acts that only change what is shown: times in s of the run, a run as run.json has it.
 * @typedef {{
 *   keep: {kept: boolean},
 *   let_go: {hold: Held},
 *   limit: {most: number},
 *   load: {run: unknown},
 *   pause: {},
 *   record: {},
 *   rest: {},
 *   run: {},
 *   seek: {time: number},
 *   show: {layer: string, shown: boolean},
 *   solve: {question: string, known: number[], halfWidths: number[]},
 *   speed: {factor: number},
 *   step: {},
 * }} ViewActs
 */
/** @typedef {EventActs & ViewActs} Acts */
/**
 * What a page asks for: an act by its name, with what it needs.
 * @template {keyof Acts} [K=keyof Acts]
 * @typedef {{[Name in K]: {act: Name} & Acts[Name]}[K]} Message
 */
/**
 * What does each of some acts.
 * @template T
 * @typedef {{[Name in keyof T]: (top: LocalTop, asked: T[Name]) => void}} Table
 */

const PUSH = 1; // rad/s by which a push changes a rate
const PULL = 0.5; // of sqrt(|Mgl|/Ix): change of the rates by a pull of one scene unit
const TORQUE_SHARE = 0.0075; // of |Mgl|: the torque of the buttons
const PUSH_TORQUE = 2; // of that torque: the mean one of pushes along
export const PUSH_RATE = 20; // pushes per s of the motion
const MOST_PUSHES = 1000; // of one press, as many as the kernel takes: its release ends them
const STEPS = 24; // of a nutation
const LONGEST_STEP = 0.05; // s of the motion
/** @type {{[way: string]: number}} */
const SIGNS = { up: -1, down: 1, along: 1, back: -1 };

/** @param {LocalTop} top @param {State} after @param {import("./run.js").Asked} asked */
const addKick = (top, after, asked) => top.add("kick", top.course.continue(after), asked);

/** @param {LocalTop} top @param {EventActs["kick"]} asked */
const kick = (top, { factor, hold }) => {
  const after = top.state.kick(top.course.top, "factor", [factor], hold);
  addKick(top, after, { act: { precession_rate_factor: factor, hold }, hold });
};

/**
 * @param {LocalTop} top
 * @param {Vector} impulse N m s, in the world frame
 * @param {string} kind of what has made it
 */
const addImpulse = (top, impulse, kind) => {
  const after = top.state.kick(top.course.top, "impulse", impulse);
  addKick(top, after, { act: { angular_impulse: impulse }, hold: null, made_by: { kind } });
};

/** @param {LocalTop} top @param {EventActs["push"]} asked */
const push = (top, { way }) => {
  const change = SIGNS[way] * PUSH;
  if (way === "along" || way === "back") {
    const hold = "spin_momentum";
    const after = top.state.kick(top.course.top, "change", [change], hold);
    addKick(top, after, { act: { precession_rate_change: change, hold }, hold });
    return;
  }
  const size = top.course.top.Ix * change;
  const { phi } = top.state.angles;
  addImpulse(top, [size * Math.cos(phi), size * Math.sin(phi), 0], way);
};

/** One of so many pushes in a second, along the precession, in N m s. @param {Course} course @param {number} rate */
export const findPush = (course, rate = PUSH_RATE) => {
  const way = Math.sign(course.free.motion.rates.mean_precession_rate) || 1;
  return (way * PUSH_TORQUE * findTorque(course)) / rate;
};

/** Push along the precession: at once, and then again and again. @param {LocalTop} top @param {AskedPushes} asked */
const pushAlong = (top, { axle_impulse, rate = PUSH_RATE, number = MOST_PUSHES }) => {
  const { course } = top;
  const impulse = axle_impulse ?? findPush(course, rate);
  const after = top.state.kick(course.top, "axle", [impulse]);
  const act = { axle_impulse: impulse, rate, number };
  top.add("push", course.continue(after, { pushes: readPushes(act) }), { act });
};

/** Push along while a button is held; another act ends those pushes. @param {LocalTop} top */
const press = (top) => {
  pushAlong(top, {});
  top.held.add("press");
};

/**
 * The angular impulse, in N m s, of a pull at the end of the axle to a point in scene units.
 * @param {Course} course @param {State} state @param {Vector} end @returns {Vector}
 */
export const findPull = ({ top: { Ix, Mgl } }, state, end) => {
  const axis = state.toWorld([0, 0, 1]);
  const size = PULL * Ix * (Math.sqrt(Math.abs(Mgl) / Ix) || 1);
  return scale(cross(axis, subtract(end, axis)), size);
};

/** The torque of the buttons, about the vertical, in N m. @param {Course} course */
export const findTorque = ({ top: { Ix, Mgl } }) => TORQUE_SHARE * (Math.abs(Mgl) || Ix);

/**
 * Apply a torque about the vertical together with that of the scene.
 * @param {LocalTop} top @param {number} sign 0 for no torque
 */
export const holdTorque = (top, sign) => {
  const [x, y, z] = top.steady;
  /** @type {Vector} */
  const torque = [x, y, z + sign * findTorque(top.course)];
  if (top.course.torque[2] === torque[2]) return;
  top.add("torque", top.course.continue(top.state, { torque }));
  top.telling.tellFacts();
};

/** Hold the precession by hand, or let it go. @param {LocalTop} top */
const clamp = (top) => {
  const { clamped } = top.course;
  top.add(clamped ? "unclamp" : "clamp", top.course.continue(top.state, { clamped: !clamped }));
};

/** Hold it while a button is held. @param {LocalTop} top */
const grasp = (top) => {
  if (top.course.clamped) return;
  clamp(top);
  top.held.add("grasp");
};

/** Let go a button. @param {LocalTop} top @param {ViewActs["let_go"]} asked */
const letGo = (top, { hold }) => {
  if (!top.held.delete(hold)) return; // its act was refused, or the motion began anew
  if (hold === "torque") holdTorque(top, 0);
  else if (hold === "press") top.release();
  else if (top.course.clamped) clamp(top);
};

/** The present motion, without the torque of a button. @param {LocalTop} top @returns {Beginning} */
export const present = ({ course: { top, friction, start, weighed }, steady }) => ({
  top,
  friction,
  start,
  torque: steady,
  weighed,
});

/** What is known of another body than the present one: gravity. @param {LocalTop} top */
const forget = (top) =>
  top.run.moments.length ? { ...top.course.weighed, mass: UNWEIGHED.mass } : UNWEIGHED;

/** @param {LocalTop} top @param {Beginning} beginning @param {import("./run.js").Asked} asked */
const begin = (top, { clamped = false, ...beginning }, asked = {}) => {
  const { top: own, friction, torque, start, weighed = forget(top) } = beginning;
  const course = new Course(top.kernel, own, start, friction, torque, null, clamped, weighed);
  top.held.clear(); // a hand that is still there holds nothing of another motion
  top.add("start", course, asked);
  top.initial = { start, clamped };
};

/** @param {LocalTop} top @param {AskedStart} asked */
const startWith = (top, { theta, theta_dot = 0, phi_dot = 0, psi_dot, precession }) => {
  const numbers = { theta: Number(theta), theta_dot, phi_dot, psi_dot };
  const start = createStart(top.kernel, top.course.top, numbers, precession);
  begin(top, { ...present(top), start });
};

/** A start with the rates of now, in another direction of the axis. @param {LocalTop} top @param {EventActs["tilt"]} asked */
const tilt = (top, { theta, phi }) => {
  const { psi_dot, phi_dot } = describeStart(top.state);
  const { psi } = top.state.angles;
  const start = createStart(top.kernel, top.course.top, { theta, phi, psi, phi_dot, psi_dot });
  begin(top, { ...present(top), start });
};

/** @param {LocalTop} top @param {EventActs["scene"]} asked */
const chooseScene = (top, { name }) => {
  const scene = findScene(top.content.scenes, name);
  begin(top, readScene(top.kernel, scene), { made_by: { kind: "scene", name } });
};

/** @param {LocalTop} top @param {EventActs["link"]} asked */
const followLink = (top, { link: { scene: name, ...texts } }) => {
  const scene = name === undefined ? null : findScene(top.content.scenes, name);
  const { event } = top.content.run_fields;
  const given = scene ? readScene(top.kernel, scene) : top.unnamed;
  const beginning = readLink(top.kernel, texts, given, event);
  const isWhole = scene && !Object.keys(texts).length;
  begin(top, beginning, isWhole ? { made_by: { kind: "scene", name } } : {});
};

/** @param {LocalTop} top */
const reset = (top) => {
  begin(top, { ...present(top), ...top.initial }, { made_by: { kind: "reset" } });
};

/**
 * A start with the motion of an event: after a kick its own words would be false.
 * @param {LocalTop} top @param {EventActs["restart"]} asked
 */
const restart = (top, { entry }) => {
  const { kind, course, asked, time } = top.run.moments[entry];
  begin(top, { ...course, torque: top.run.findSteady(time) }, kind === "start" ? asked : {});
};

/** @param {LocalTop} top @param {EventActs["set"]} asked */
const setParameter = (top, { name, value }) => {
  const [group, key] = name.split(".");
  const friction = [...top.course.friction];
  const own = { ...top.course.top };
  if (group === "friction") friction[NAMES.friction_kind.indexOf(key)] = value;
  else own[/** @type {keyof typeof own} */ (key)] = value;
  const made_by = { kind: "parameter", name: key, value };
  const { clamped } = top.course;
  const weighed = group === "friction" ? top.course.weighed : forget(top);
  const course = top.course.continue(top.state, { top: own, friction, clamped, weighed });
  top.add("change", course, { made_by });
};

/** Another top: that of a body of parts. @param {LocalTop} top @param {EventActs["body"]} asked */
const takeBody = (top, { parts }) => {
  const { clamped, weighed } = top.course;
  const { mass, top: own } = top.kernel.findBody(parts, weighed.gravity);
  const changes = { top: own, clamped, weighed: { ...weighed, mass } };
  top.add("change", top.course.continue(top.state, changes));
};

/** What starts have what is known of them. @param {LocalTop} top @param {ViewActs["solve"]} asked */
const solve = (top, { question, known, halfWidths }) => {
  const { kernel, course } = top;
  const solved =
    question === BALANCE
      ? solveBalance(course.top, known, halfWidths)
      : kernel.solveStart(course.top, question, known, halfWidths);
  top.tell({ solved });
};

/** @param {LocalTop} top */
const step = (top) => {
  const length = Math.min(top.course.free.motion.nutation_period / STEPS, LONGEST_STEP);
  top.step(Math.round(length * NANO));
};

/** What makes an event: what came later is no longer part of the run. @type {Table<EventActs>} */
const EVENTS = {
  body: takeBody,
  clamp,
  grasp,
  kick,
  press,
  push,
  pushes: (top, asked) => {
    pushAlong(top, asked);
    top.demandPushes();
  },
  restart,
  link: followLink,
  pull: (top, { end }) => addImpulse(top, findPull(top.course, top.state, end), "pull"),
  reset,
  scene: chooseScene,
  set: setParameter,
  start: startWith,
  tilt,
  torque: (top, { sign }) => {
    holdTorque(top, sign);
    top.held.add("torque");
  },
};

/** What would act on a precession that a hand holds. */
const TOUCHES = ["kick", "press", "push", "pushes", "pull", "torque"];

/** What only changes what is shown. @type {Table<ViewActs>} */
const VIEWS = {
  solve,
  step,
  keep: (top, { kept }) => top.keep(kept),
  let_go: letGo,
  limit: (top, { most }) => {
    top.most = most;
  },
  load: (top, { run }) => top.load(run),
  pause: (top) => top.setRunning(!top.isRunning),
  record: (top) => top.record(),
  rest: (top) => top.setRunning(false),
  run: (top) => top.setRunning(true),
  seek: (top, { time }) => top.seek(Math.round(time * NANO)),
  show: (top, { layer, shown }) => {
    top.layers[layer] = shown;
  },
  speed: (top, { factor }) => top.setSpeed(factor),
};

/** @type {Table<Acts>} */
const ACTS = { ...EVENTS, ...VIEWS };

/**
 * Do what a page asks for; a refusal is thrown.
 * @template {keyof Acts} K
 * @param {LocalTop} top
 * @param {Message<K>} message
 */
export const perform = (top, message) => {
  if (TOUCHES.includes(message.act) && top.course.clamped)
    throw new RangeError(phrase("refused.held"));
  ACTS[message.act](top, message);
  if (message.act in EVENTS) top.end = top.time;
};
