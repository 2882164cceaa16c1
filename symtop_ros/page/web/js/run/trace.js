// The states of the last seconds: the trace of the scene, and the curves of the charts.

import { NANO } from "../physics/course.js";
import { chooseWindow } from "../words/facts.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @import { LocalTop } from "./local.js" */

const POINTS = [240, 960]; // the fewest and the most
const NUTATION = 64; // points of the trace in a nutation: its pieces are not seen

export class Trace {
  /** @param {LocalTop} top */
  constructor(top) {
    this.top = top;
    this.window = 1; // s
    this.points = POINTS[0];
    /** States of the last frame by their times in ns. @type {Map<number, State>} */
    this.states = new Map();
  }

  /** Begin anew for a motion. @param {Course} course */
  begin({ free }) {
    this.window = chooseWindow(free);
    const wanted = (NUTATION * this.window) / free.motion.nutation_period || 0;
    this.points = Math.min(Math.max(wanted, POINTS[0]), POINTS[1]);
    this.states.clear();
  }

  /** The time in ns at which the last window begins. */
  get since() {
    const { run, time } = this.top;
    return Math.max(run.findStart(time), time - this.window * NANO);
  }

  /** Times of the last window in ns: those of a grid, and now. */
  listTimes() {
    const { time } = this.top;
    const begin = this.since;
    const step = Math.max(1, Math.round((this.window * NANO) / this.points));
    const first = Math.ceil(begin / step) * step;
    const count = Math.max(0, Math.ceil((time - first) / step));
    return [...Array.from({ length: count }, (_, n) => first + n * step), time];
  }

  /**
   * States at times, the last of which is now. Those of the frame before are kept: in a frame a few
   * are new.
   * @param {number[]} times ns
   */
  findStates(times) {
    const { run, state } = this.top;
    const before = this.states;
    const past = times.slice(0, -1).map((time) => before.get(time) ?? run.at(time));
    this.states = new Map(past.map((each, n) => [times[n], each]));
    return [...past, state];
  }
}
