// A running node as the top of the page: its events and its attitude come from the server of the
// page, and what the page asks for goes to the services of the node.

import { findTorque, perform, present } from "./acts.js";
import { NANO } from "../physics/course.js";
import { nameError } from "./errors.js";
import { LocalTop } from "./local.js";
import { State } from "../physics/state.js";
import { phrase } from "../words/wording.js";

/** @import { Held, Message } from "./acts.js" */
/** @import { Course } from "../physics/course.js" */
/** @import { EventRecord } from "./run.js" */
/** @import { Quaternion } from "../physics/kernel.js" */
/** @typedef {{service: string, argument?: any} | {torque: number[]} | {hold: Held}} Request */
/**
 * An event of the node, as the bridge sends it: its stamp in ns, and of one that changes the motion its
 * record. A release is the number of the pushes that were given.
 * @typedef {{name: string, stamp: string, said: string, running: boolean, factor: number,
 *   recording?: boolean, record?: EventRecord | {kind: "release", time: number}}} NodeEvent
 */
/**
 * What is new: events, all of them if the run is; the newest attitude with its time in ns; and a
 * sentence if the node is lost.
 * @typedef {{events?: NodeEvent[], new?: boolean, time?: number, orientation?: Quaternion,
 *   lost?: string | null}} NodeNews
 */

const RELEASE = "release"; // service, and event: pushes have ended
const CLAMP = "clamp"; // service
const RENEWED = 500; // ms; the server lets go a torque of which it has not heard for 3 s
const TOLD = ["record", "failure"]; // events of which the page says what the node said

export class NodeTop extends LocalTop {
  /** @type {Quaternion | null} */
  orientation = null; // that the node has published last
  isGreeted = false;
  latest = 0; // ns of the run, of the last event
  stamp = ""; // ns of the node's clock, of the last event
  /** Requests of the act that is performed. @type {Request[]} */
  requests = [];
  renewal = 0; // timer, while a button holds a torque
  /** Settled when all that was asked is answered. @type {Promise<void>} */
  sent = Promise.resolve();

  /** Begin: the page is greeted with the first news of the node. */
  open() {
    const news = new EventSource("/news");
    news.onmessage = ({ data }) => this.follow(JSON.parse(data));
    news.onerror = () => this.tell({ lost: phrase("page.disconnected") });
  }

  /** @param {NodeNews} news */
  follow({ events = [], new: isNew = false, time, orientation, lost }) {
    if (isNew) this.beginRun(events);
    for (const event of events) this.followEvent(event);
    if (lost !== undefined) this.tell({ lost });
    if (!this.run.moments.length) return;
    if (time !== undefined && orientation) {
      const { course } = this;
      this.time = this.end = Math.max(time, this.latest);
      if (this.isGreeted) this.cross(course);
      this.orientation = orientation;
    }
    if (isNew && !this.isGreeted) {
      this.isGreeted = true;
      this.present();
    }
    if (!events.length) return;
    this.frames.stir();
    this.telling.tellFacts();
  }

  /**
   * The page sees a node for the first time, the server was started again, or the node was.
   * @param {NodeEvent[]} events of the run
   */
  beginRun(events) {
    const isKnown = events.some(({ stamp }) => stamp === this.stamp);
    if (this.stamp && !isKnown) this.tell({ said: phrase("page.new_run") });
    this.run.moments = [];
  }

  /** @param {NodeEvent} event */
  followEvent({ record, running, factor, recording, said, name, stamp }) {
    this.stamp = stamp;
    if (record?.kind === RELEASE) this.run.release(Math.round(record.time * NANO));
    else if (record) {
      this.run.append(record);
      this.latest = Math.round(record.time * NANO);
      this.time = this.end = Math.max(this.time, this.latest);
      this.orientation = null;
      this.changed();
    }
    this.isRunning = running;
    this.speed = factor;
    if (recording !== undefined) this.isRecording = recording;
    if (TOLD.includes(name)) this.tell({ said });
  }

  /** The torque without that of a button, which is an event of its own. */
  get steady() {
    const { moments } = this.run;
    return (moments.findLast(({ kind }) => kind !== "torque") ?? moments[0]).course.torque;
  }

  /** The body is that of the node. @returns {import("./links.js").Beginning} */
  get unnamed() {
    return present(this);
  }

  /** The published attitude; all else follows from the events. */
  get state() {
    const computed = super.state;
    return this.orientation ? new State(this.kernel, this.orientation, computed.omega) : computed;
  }

  /** Show what has come: the node has the time. @param {number} _ ms @param {number} now ms */
  advance(_, now) {
    this.show(now);
  }

  /** @param {Message} message @returns {boolean} */
  take(message) {
    this.requests = [];
    try {
      if (message.act === "reset") this.ask("reset");
      else if (message.act === "torque") this.turn(message.sign);
      else if (message.act === "let_go") this.letGo(message.hold);
      else perform(this, message);
    } catch (error) {
      this.tell({ refused: nameError(error) });
      return false;
    }
    this.send(this.requests);
    return true;
  }

  record() {
    this.ask("record", !this.isRecording);
  }

  /** Ask for a torque about the vertical; the server repeats it, as long as it hears of the hold. @param {number} sign */
  turn(sign) {
    this.requests.push({ torque: [0, 0, sign * findTorque(this.course)] });
    this.held.add("torque");
    clearInterval(this.renewal);
    this.renewal = window.setInterval(() => this.send([{ hold: "torque" }]), RENEWED);
  }

  /** @param {Held} hold */
  letGo(hold) {
    const isHeld = this.held.delete(hold);
    if (hold === "torque") {
      // of a motion that began anew as well: the server repeats the torque until it hears of the end
      clearInterval(this.renewal);
      this.requests.push({ torque: [0, 0, 0] });
    } else if (!isHeld) return;
    else if (hold === "press") this.release();
    else this.ask(CLAMP, false);
  }

  /** End the pushes: those that the node has not given yet. */
  release() {
    const { number = 0 } = this.run.find(this.time);
    const { pushes } = this.run.findEvent(this.time).course;
    if (pushes && number < pushes.number) this.ask(RELEASE);
  }

  /** The node refuses pushes of which one cannot be. */
  demandPushes() {}

  /** @param {string} service @param {any} [argument] */
  ask(service, argument = null) {
    this.requests.push({ service, argument });
  }

  /**
   * Ask for an event; the node sends it when it has taken effect.
   * @param {import("./run.js").Kind} kind
   * @param {Course} course
   * @param {import("./run.js").Asked} [asked]
   */
  add(kind, course, asked) {
    if (kind === "kick" || kind === "push") {
      this.ask("kick", asked?.act);
      return;
    }
    if (kind === "clamp" || kind === "unclamp") {
      this.ask(CLAMP, course.clamped);
      return;
    }
    const changes = listChanges(this.course, course);
    if (kind === "start") Object.assign(changes, this.listHeld(course));
    if (Object.keys(changes).length) this.ask("set_parameters_atomically", changes);
    if (kind !== "start") return;
    const [w, x, y, z] = course.start.given;
    const { omega } = course.start;
    this.ask("set_initial_conditions", { orientation: [x, y, z, w], angular_velocity: omega });
  }

  /** What a start must change so that it begins held or free. @param {Course} course */
  listHeld({ clamped }) {
    if (this.course.clamped) this.ask(CLAMP, false); // friction and torques may follow
    const isHeld = this.run.moments.some((each) => each.kind === "start" && each.course.clamped);
    return clamped || isHeld ? { "initial.clamped": clamped } : {};
  }

  /** @param {boolean} isRunning */
  setRunning(isRunning) {
    if (isRunning !== this.isRunning) this.ask("pause", !isRunning);
  }

  /** @param {number} speed */
  setSpeed(speed) {
    this.ask("set_parameters_atomically", { real_time_factor: speed });
  }

  /** @param {number} length ns */
  step(length) {
    this.setRunning(false);
    this.ask("step", { duration: length / NANO });
  }

  load() {
    throw new RangeError(phrase("page.not_with_node"));
  }

  /**
   * Ask after what was asked before: a hold that is let go soon must not end before it begins.
   * @param {Request[]} requests
   */
  send(requests) {
    this.sent = this.sent.then(() => this.sendNow(requests));
  }

  /** Ask one after the other, until one is refused. @param {Request[]} requests */
  async sendNow(requests) {
    for (const request of requests) {
      const { granted, answer } = await post(request);
      if (!granted) {
        this.tell({ refused: answer });
        return;
      }
    }
    this.tell({ granted: true });
  }
}

/** The parameters of a node that differ between two courses. @param {Course} before @param {Course} after */
const listChanges = (before, after) => {
  const [old, wanted] = [listParameters(before), listParameters(after)];
  const changed = Object.entries(wanted).filter(
    ([name, value]) => String(value) !== String(old[name]),
  );
  return Object.fromEntries(changed);
};

/** @param {Course} course @returns {{[name: string]: number | number[]}} */
const listParameters = ({ parameters, weighed, torque }) => ({
  ...parameters,
  ...weighed,
  steady_torque: torque,
});

/** @param {Request} request @returns {Promise<{granted: boolean, answer: string}>} */
const post = async (request) => {
  try {
    const answer = await fetch("/request", { method: "POST", body: JSON.stringify(request) });
    if (answer.ok) return await answer.json();
    return { granted: false, answer: await answer.text() };
  } catch {
    return { granted: false, answer: phrase("page.disconnected") };
  }
};
