// What a page shows instead of its scene without WebGL 2: the way of the axle, as seen from above.
//
// The distance from the middle is theta, so that all tilts have a place; the direction is that of phi.

import { find } from "../controls/document.js";
import { draw } from "./plot.js";
import { writeAngle } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { LocalTop } from "../run/local.js" */
/** @import { State } from "../physics/state.js" */
/** @typedef {[number, number]} Point */

const [WIDE, HEIGHT, RADIUS] = [300, 230, 100]; // units of the drawing, and of its largest circle
const ROOM = 1.08; // of the largest tilt
const LEAST = 0.02; // rad: a vertical axis is no point

/** What is east and north of the middle, for a tilt that is at the circle. @param {State} state @param {number} most */
const findPlace = ({ orientation, angles }, most) => {
  // Of the axis, whose direction changes nowhere suddenly: phi does next to the vertical.
  const [w, x, y, z] = orientation;
  const [east, north] = [x * z + w * y, y * z - w * x];
  const size = Math.hypot(east, north) || 1;
  const far = (angles.theta / most) * RADIUS;
  return /** @type {Point} */ ([WIDE / 2 + (far * east) / size, HEIGHT / 2 - (far * north) / size]);
};

/** @param {Point[]} points */
const writePath = (points) =>
  points.map(([x, y], k) => `${k ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

/** @param {number} theta @param {number} most @param {string} style */
const drawCircle = (theta, most, style) => {
  const radius = (theta / most) * RADIUS;
  const text = `<text x="${WIDE / 2 + 3}" y="${(HEIGHT / 2 - radius - 3).toFixed(1)}">${writeAngle(theta)}</text>`;
  return `<circle cx="${WIDE / 2}" cy="${HEIGHT / 2}" r="${radius.toFixed(1)}" fill="none" ${style}/>${text}`;
};

export class TraceChart {
  /** @param {LocalTop} top */
  constructor(top) {
    this.top = top;
    this.most = LEAST;
    for (const id of ["picture", "labels", "legend", "save-picture"]) find(id).hidden = true;
    find("plain").hidden = false;
  }

  /** What holds for a whole motion: the largest tilt that is shown. */
  begin() {
    const { turning_angles } = this.top.telling.free.motion;
    this.most = Math.max(turning_angles[1], this.top.state.angles.theta, LEAST) * ROOM;
  }

  /** @param {State} state now @param {State[]} states of the trace */
  draw(state, states) {
    draw("plain", HEIGHT, this.write(state, states), phrase("page.plain"));
  }

  /** @param {State} state now @param {State[]} states of the trace */
  write(state, states) {
    const { top } = this;
    const most = [...states, state].reduce(
      (tilt, { angles }) => Math.max(tilt, angles.theta),
      this.most,
    );
    const place = (/** @type {State} */ each) => findPlace(each, most);
    const ghost = top.layers.ghost ? top.run.findGhost(top.time) : null;
    const dot = (/** @type {State} */ each, /** @type {string} */ style) => {
      const [x, y] = place(each).map((part) => part.toFixed(1));
      return `<path d="M${WIDE / 2} ${HEIGHT / 2}L${x} ${y}" stroke-width="2" ${style}/><circle cx="${x}" cy="${y}" r="6" ${style}/>`;
    };
    const { marks, trace } = top;
    const seen = top.layers.points ? marks.list(trace.since, top.time) : [];
    const dots = seen.filter(({ shows }) => shows.includes("phi")).map((each) => place(each.state));
    const circles = top.telling.free.motion.turning_angles.filter((theta) => theta > 0);
    return `${circles.map((theta) => drawCircle(theta, most, 'stroke="var(--grey)" stroke-dasharray="2 3"')).join("")}
      <path d="${writePath([...states, state].map(place))}" fill="none" stroke="var(--phi)" stroke-width="1.8" id="way"/>
      <path d="${dots.map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`).join("")}" stroke="var(--dim)" stroke-width="3.4" stroke-linecap="round" class="seen"/>
      ${ghost ? dot(ghost, 'fill="var(--grey)" stroke="var(--grey)" class="ghost"') : ""}
      ${dot(state, 'fill="var(--theta)" stroke="var(--theta)" class="axle"')}
      <circle cx="${WIDE / 2}" cy="${HEIGHT / 2}" r="2" fill="currentColor"/>`;
  }

  /** The drawing of another top. @param {LocalTop} other @returns {Element} */
  lend(other) {
    const own = this.top;
    try {
      this.top = other;
      this.begin();
      const states = other.trace.findStates(other.trace.listTimes());
      const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      svg.setAttribute("viewBox", `0 0 ${WIDE} ${HEIGHT}`);
      svg.innerHTML = this.write(other.state, states);
      return svg;
    } finally {
      this.top = own;
      this.begin();
    }
  }
}
