// The measured points of a run as marks: states of the top, of each of which a part was seen.

import { NANO } from "../physics/course.js";
import { State } from "../physics/state.js";
import { findAngles } from "../scene/grip.js";

/** @import { Course } from "../physics/course.js" */
/** @import { Vector } from "../physics/kernel.js" */
/** @import { LocalTop } from "./local.js" */
/**
 * Measured points as in run.json: rows of values by the columns of their kind, at times in s, and what
 * the motion leaves of them.
 * @typedef {{kind: string, rows: number, times: number[], values: number[][], residuals: number[][],
 *   camera?: {[name: string]: number}}} Points
 */
/**
 * A point by its place among all: its time in ns, what was seen as a state, the course of then, and the
 * quantities that were seen.
 * @typedef {{place: number, time: number, state: State, course: Course, shows: string[]}} Mark
 */

const MOST = 600; // in a picture; of more every second, third ...
const NEAR = 14; // px between the pointer and a point
const AXIS = ["theta", "phi"];
const RATES = ["theta_dot", "phi_dot", "psi_dot"];
/** @type {{[kind: string]: string[]}} others show the axis */
const SHOWS = { attitude: [...AXIS, "psi"], rates: RATES, inertial: RATES, theta: ["theta"] };

/** Points up to a time in ns of the run. @param {Points | null} points @param {number} end */
export const cutPoints = (points, end) => {
  const count = points ? countUntil(points, end) : 0;
  if (!points || count === points.times.length) return points;
  if (!count) return null;
  const [times, values, residuals] = [points.times, points.values, points.residuals].map((each) =>
    each.slice(0, count),
  );
  return /** @type {Points} */ ({ ...points, times, values, residuals });
};

/** @param {Points} points @param {number} end ns */
const countUntil = ({ times }, end) => {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (Math.round(times[middle] * NANO) > end) high = middle;
    else low = middle + 1;
  }
  return low;
};

/** The time in ns until which a point is the last one: that of the next, or as long as the step before. @param {Points} points @param {number} place */
const endPoint = ({ times }, place) =>
  Math.round(NANO * (times[place + 1] ?? 2 * times[place] - (times[place - 1] ?? times[place])));

/**
 * Twin of unproject in run/simulation/points.py: of the two axes that a camera sees at a point the one
 * that is nearer to that of the motion.
 * @param {number[]} seen u and v @param {{[name: string]: number}} camera @param {Vector} axis
 * @returns {Vector}
 */
const unproject = (seen, camera, axis) => {
  const size = Math.exp(-camera.log_scale);
  const [u, v] = [(seen[0] - camera.u) * size, (seen[1] - camera.v) * size];
  const [cos, sin, n] = [Math.cos(camera.roll), Math.sin(camera.roll), camera.nearness];
  const [a, b] = [cos * u + sin * v, cos * v - sin * u];
  const s = a * a + b * b;
  const [up, out] = [Math.sin(camera.elevation), Math.cos(camera.elevation)];
  const known = axis[2] * up - axis[1] * out;
  const root = Math.sqrt(1 - s + s * n * n);
  const [front, back] = [root, -root].map((each) => (s * n + each) / (1 + s * n * n));
  const near = Math.abs(front - known) <= Math.abs(back - known) ? front : back;
  const [right, high] = [a * (1 - n * near), b * (1 - n * near)];
  return [right, high * up - near * out, high * out + near * up];
};

/** What was seen, as a state. @param {Points} points @param {number} place @param {State} motion */
const see = ({ kind, values, camera = {} }, place, motion) => {
  const row = values[place];
  const { kernel, orientation, omega, angles } = motion;
  if (SHOWS[kind] === RATES) return new State(kernel, orientation, row.slice(0, 3));
  if (kind === "attitude") {
    const norm = Math.hypot(...row);
    return new State(
      kernel,
      row.map((each) => each / norm),
      omega,
    );
  }
  if (kind === "theta") return State.fromEuler(kernel, { ...angles, theta: row[0] });
  if (kind === "angles") return State.fromEuler(kernel, { theta: row[0], phi: row[1] });
  const axis = /** @type {Vector} */ (row);
  const seen = kind === "axis" ? axis : unproject(row, camera, motion.toWorld([0, 0, 1]));
  return State.fromEuler(kernel, findAngles(seen));
};

export class Marks {
  /** @param {LocalTop} top */
  constructor(top) {
    this.top = top;
    /** Those that are known, by their places; null without a state. @type {Map<number, Mark | null>} */
    this.found = new Map();
    /** The place of the one that is pointed at. @type {number | null} */
    this.pointed = null;
    /**
     * Where marks were drawn last, by the ids of elements: places in units, of which an element is so
     * many wide. @type {{[id: string]: {dots: [number, number, number][], wide: number}}}
     */
    this.drawn = {};
  }

  /** Another motion holds, or other points. */
  begin() {
    this.found.clear();
    this.drawn = {};
    this.pointed = null;
  }

  /** The marks of a time, or some of them. @param {number} begin ns @param {number} end ns */
  list(begin, end) {
    const { points } = this.top;
    if (!points) return [];
    const [first, last] = [countUntil(points, begin - 1), countUntil(points, end)];
    const step = Math.ceil((last - first) / MOST) || 1;
    const marks = [];
    for (let place = Math.ceil(first / step) * step; place < last; place += step)
      marks.push(this.find(points, place));
    return marks.filter((each) => each !== null);
  }

  /**
   * The top as it was measured last: with the axis of the last point, and the spin of the motion, which no
   * point of the axis shows. Null before the first point, after the last one, and after an act.
   */
  findGhost() {
    const { points, run, time, kernel, course } = this.top;
    const place = points ? countUntil(points, time) - 1 : -1;
    if (!points || place < 0 || time > endPoint(points, place)) return null;
    const mark = this.find(points, place);
    if (!mark?.shows.includes("phi") || mark.course !== course) return null;
    if (mark.shows.includes("psi")) return mark.state;
    const { theta, phi } = mark.state.angles;
    return State.fromEuler(kernel, { theta, phi, psi: run.at(time).angles.psi });
  }

  /** @param {Points} points @param {number} place */
  find(points, place) {
    if (!this.found.has(place)) this.found.set(place, this.make(points, place));
    return this.found.get(place) ?? null;
  }

  /** @param {Points} points @param {number} place @returns {Mark | null} */
  make(points, place) {
    const time = Math.round(points.times[place] * NANO);
    const { run } = this.top;
    try {
      const state = see(points, place, run.at(time));
      const shows = SHOWS[points.kind] ?? AXIS;
      return { place, time, state, course: run.find(time).course, shows };
    } catch {
      return null; // beside the sphere, or no direction
    }
  }

  /**
   * Keep where marks are drawn.
   * @param {string} id of an element @param {[number, number, number][]} dots with their places
   * @param {number} wide units of the element
   */
  keep(id, dots, wide) {
    this.drawn[id] = { dots, wide };
  }

  /** Point at the mark that is drawn next to the pointer. @param {PointerEvent} event */
  follow({ target, clientX, clientY }) {
    if (!this.top.points) return;
    const ids = Object.keys(this.drawn);
    const id = ids.find((each) =>
      document.getElementById(each)?.contains(/** @type {Node} */ (target)),
    );
    let nearest = NEAR;
    this.pointed = null;
    if (!id) return;
    const { dots, wide } = this.drawn[id];
    const { left, top, width } = /** @type {Element} */ (
      document.getElementById(id)
    ).getBoundingClientRect();
    for (const [x, y, place] of dots) {
      const scale = width / wide;
      const far = Math.hypot(left + x * scale - clientX, top + y * scale - clientY);
      if (far < nearest) [nearest, this.pointed] = [far, place];
    }
  }

  /** What is told of the points: of the one that is pointed at, or else the last one up to now. */
  describe() {
    const { points, time } = this.top;
    if (!points) return null;
    const {
      columns,
      residuals: names = columns,
      units,
    } = this.top.content.run_fields.points.kinds[points.kind];
    const place = this.pointed ?? Math.max(countUntil(points, time) - 1, 0);
    const left = names.map((name, k) => ({
      name,
      unit: units[k],
      value: points.residuals[place][k],
    }));
    return { ...points, count: points.times.length, time: points.times[place], left };
  }
}
