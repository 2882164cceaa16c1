// The charts of the page. Those that are out of sight are not drawn, and the others in turn, one in a
// frame: drawn together, they would take longer than all else in it. Texts and tables are always those
// of now, in sight or not, for a screen reader and a search; a printer gets all charts.

import { showConstants } from "./constants_table.js";
import { findAll } from "../controls/document.js";
import { guard } from "../controls/notices.js";
import { FreeChart } from "./free_chart.js";
import { drawHand } from "./hand_chart.js";
import { drawImpulses } from "./impulses_chart.js";
import { NANO } from "../physics/course.js";
import { findHand } from "../words/hand.js";
import { drawRule } from "./rule_chart.js";
import { drawOneSeries } from "./series_charts.js";
import { drawWell } from "./well_chart.js";

/** @import { Facts } from "../words/facts.js" */
/** @import { Sample } from "../run/telling.js" */
/** @import { Mark, Marks } from "../run/marks.js" */
/** @typedef {(facts: Facts, samples: Sample[], factor: number, marks: Mark[]) => void} Draw */

export class Charts {
  /** @param {(isKept: boolean) => void} keep a run for comparison, or let it go */
  constructor(keep) {
    const free = new FreeChart(keep);
    /** Those of the top that is shown. @type {Marks | null} */
    this.marks = null;
    /** @param {"theta" | "phi_dot" | "psi_dot"} id @returns {Draw} */
    const listSeries = (id) => (facts, samples, _, marks) => {
      if (this.marks) drawOneSeries(id, samples, facts, marks, this.marks);
    };
    /** @type {{[name: string]: Draw}} */
    this.all = {
      rule: (facts, samples, factor) => drawRule(facts, last(samples).state, factor),
      well: ({ potential }, samples) => drawWell(potential, last(samples).state.angles.theta),
      theta: listSeries("theta"),
      phi_dot: listSeries("phi_dot"),
      psi_dot: listSeries("psi_dot"),
      impulses: ({ began }, samples) => {
        const { course, time } = last(samples);
        if (!course.clamped) drawImpulses(course, time / NANO - began);
      },
      hand: ({ pusher }, samples) => {
        const { course, state } = last(samples);
        drawHand(findHand(course, state, pusher));
      },
      free: (_, samples, __, marks) => {
        if (this.marks) free.draw(samples, marks, this.marks);
      },
    };
    /** @type {Draw} */
    this.write = guard("tables", ({ table }, samples) => {
      showConstants(table, last(samples), this.mass);
      free.write(samples);
    });
    for (const [name, draw] of Object.entries(this.all)) this.all[name] = guard(name, draw);
    /** Names of the charts in sight. @type {Set<string>} */
    this.seen = new Set();
    /** Those that are still to be drawn. @type {string[]} */
    this.waiting = [];
    this.mass = NaN; // kg, of the body that the top is
    this.isComplete = false; // each has been drawn once, and has its height
    const observer = new IntersectionObserver((changes) => changes.forEach(this.follow, this));
    for (const place of findAll("[data-chart]")) observer.observe(place);
    addEventListener("beforeprint", () => this.drawAll());
  }

  /** @param {IntersectionObserverEntry} change */
  follow({ target, isIntersecting }) {
    const { chart = "" } = /** @type {HTMLElement} */ (target).dataset;
    if (!isIntersecting) this.seen.delete(chart);
    else if (!this.seen.has(chart)) {
      this.seen.add(chart);
      this.drawOne?.(chart); // a top that waits sends no frame
    }
  }

  /**
   * Draw what a frame shows, in the next frames.
   * @param {Facts} facts
   * @param {Sample[]} samples
   * @param {number} factor by which Hurry multiplies phi'
   * @param {Mark[]} marks of measured points
   */
  draw(facts, samples, factor, marks) {
    this.drawOne = (/** @type {string} */ name) => this.all[name]?.(facts, samples, factor, marks);
    this.write(facts, samples, factor, marks);
    if (!this.isComplete) this.drawAll();
    this.isComplete = true;
    if (this.waiting.length) return; // these will be drawn from what is shown now
    this.waiting = [...this.seen];
    this.drawNext();
  }

  drawAll() {
    for (const name of Object.keys(this.all)) this.drawOne?.(name);
  }

  drawNext() {
    if (!this.waiting.length) return;
    requestAnimationFrame(() => {
      this.drawOne?.(/** @type {string} */ (this.waiting.shift()));
      this.drawNext();
    });
  }
}

/** @param {Sample[]} samples */
const last = (samples) => samples[samples.length - 1];
