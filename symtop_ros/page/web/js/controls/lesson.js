// The lesson: a step at a time, with a prediction, buttons that make its motions, and its charts.

import { find, findAll, make, say, write } from "./document.js";
import { keep, read } from "./choices.js";
import { convertTyped } from "./typed.js";
import { recall, remember } from "../run/memory.js";
import { writeNumber } from "../words/numbers.js";
import { parseQuantity, writeLimit } from "../words/quantities.js";
import { UNITS } from "../words/units.js";
import { isKnown, phrase } from "../words/wording.js";

/** @import { Hold } from "../physics/kernel.js" */
/** @import { Message } from "../run/acts.js" */
/**
 * A button of a step, as in lesson.yaml: one of a start, a hurry, a push, a clamp and a run with measured
 * points.
 * @typedef {{start: {[name: string]: any} | null, hurry: number | null, hold: Hold,
 *   push: {[name: string]: number} | null, clamp: boolean | null, run: unknown}} Act
 */
/** A number that is predicted, in rad, and how near the prediction is to be. @typedef {{value: number, within: number}} Ask */
/** Numbers in rows, and the form of each column. @typedef {{forms: string[], rows: number[][]}} Table */
/**
 * @typedef {{name: string, acts: Act[], scene: string, charts: string[], layers: string[],
 *   ask: Ask | null, table: Table | null}} Step
 */
/** @typedef {(message: Message) => void} Send */

const WITHIN_DIGITS = 3;
const PREDICTIONS = "predictions"; // as the browser keeps them

/** What was predicted, by the number of the step. @returns {{[step: number]: string}} */
export const readPredictions = () => {
  try {
    const kept = Object.entries(JSON.parse(read(PREDICTIONS) ?? "{}"));
    return Object.fromEntries(kept.filter(([, text]) => typeof text === "string"));
  } catch {
    return {}; // of another version of the page
  }
};

/**
 * What was predicted, in words: the answer to the first question, and that of each step.
 * @param {Step[]} steps @param {string | null} answer
 */
export const writePredictions = (steps, answer) => {
  const predictions = Object.entries(readPredictions()).filter(([, text]) => text);
  const lines = predictions.map(([place, text]) => {
    const number = Number(place);
    const step = steps[number - 1];
    const title = step ? phrase(`lesson.${step.name}.title`) : "";
    return phrase("predictions", { kind: "step", number, title, text });
  });
  if (answer !== null) lines.unshift(phrase("predictions", { kind: "first", answer }));
  return `${lines.join("\n") || phrase("predictions", { kind: "none" })}\n`;
};

/** What a button asks for. @param {Act} act @param {string} scene @returns {Message} */
export const nameAct = ({ start, push, clamp, run, hurry: factor, hold }, scene) => {
  if (run) return { act: "load", run };
  if (clamp) return { act: "clamp" };
  if (start) return { act: "link", link: { scene, ...start } };
  if (push) return { act: "pushes", ...push };
  return { act: "kick", factor: /** @type {number} */ (factor), hold };
};

/** The numbers that a step explains. @param {Step} step @returns {HTMLElement[]} */
export const makeTable = ({ name, table }) => {
  if (!table) return [];
  const heads = table.forms.map((_, k) => makeCell("th", phrase(`lesson.${name}.column_${k + 1}`)));
  const rows = table.rows.map((row) =>
    make("tr", {}, ...row.map((each, k) => makeCell("td", writeNumber(each, table.forms[k])))),
  );
  return [make("table", { className: "counts" }, make("tr", {}, ...heads), ...rows)];
};

/** @param {"th" | "td"} tag @param {string} text */
const makeCell = (tag, text) => {
  const cell = make(tag);
  write(cell, text);
  return cell;
};

/**
 * How near a number that was typed is to the one that is asked for.
 * @param {Ask} ask @param {string} typed
 */
export const checkNumber = (ask, typed) => {
  if (!typed.trim()) return "";
  const number = parseQuantity(typed, UNITS.rad);
  if (Number.isNaN(number)) return phrase("asked", { kind: "none" });
  const within = writeWithin(ask);
  const isNear = Math.abs(number - ask.value) <= parseQuantity(within, UNITS.rad);
  return phrase("asked", { kind: isNear ? "near" : "far", within });
};

/** How near a number is to be, in the unit of the page: what is written is what holds. @param {Ask} ask */
const writeWithin = ({ within }) => writeLimit(within, -1, "rad", WITHIN_DIGITS);

const TEXTS = ["title", "predict", "compute", "look", "seen", "question", "answer"];

export class Lesson {
  /** @param {Step[]} steps @param {Send} send @param {(step: Step) => void} prepare what a step shows */
  constructor(steps, send, prepare) {
    this.steps = steps;
    this.send = send;
    this.prepare = prepare;
    this.select = find("steps", HTMLSelectElement);
    this.field = find("prediction", HTMLTextAreaElement);
    this.number = find("predicted-number", HTMLInputElement);
    /** Number of the step that is shown. @type {number | null} */
    this.shown = null;
    /** @type {HTMLButtonElement[]} */
    this.hurries = [];
    this.isAwaited = false; // the motion that a button has asked for
    this.predictions = readPredictions();
    this.select.append(
      ...steps.map(({ name }, k) =>
        make("option", { textContent: `${k + 1}. ${phrase(`lesson.${name}.title`)}` }),
      ),
    );
    this.listen();
  }

  listen() {
    this.select.addEventListener("change", () => this.show(this.current));
    this.field.addEventListener("input", () => this.predict(this.current, this.field.value));
    this.number.addEventListener("change", () => this.check());
    find("step-back").addEventListener("click", (event) => this.go(-1, event));
    find("step-next").addEventListener("click", (event) => this.go(1, event));
    find("tab-lesson").addEventListener("click", () => {
      if (!find("lesson").hidden && !location.hash.startsWith("#lesson=")) this.show(this.current);
    });
    addEventListener("popstate", () => {
      const [, number] = location.hash.match(/^#lesson=(\d+)$/) ?? [];
      const step = this.limit(Number(number));
      if (number && step !== this.shown) this.show(step, true);
    });
  }

  get current() {
    return this.select.selectedIndex + 1;
  }

  /** The number of a step that is there. @param {number} number of an address */
  limit(number) {
    return Math.min(Math.max(Math.round(number) || 1, 1), this.steps.length);
  }

  /** Open the tab of the lesson at a step. @param {number} number */
  open(number) {
    if (find("lesson").hidden) find("tab-lesson").click();
    this.show(this.limit(number));
  }

  /** @param {number} by @param {MouseEvent} event */
  go(by, event) {
    this.show(this.current + by);
    if (event.detail) this.select.scrollIntoView();
    else this.select.focus();
  }

  /** @param {number} number @param {string} text */
  predict(number, text) {
    // Another tab may have written others.
    this.predictions = { ...this.predictions, ...readPredictions(), [number]: text };
    keep(PREDICTIONS, JSON.stringify(this.predictions));
  }

  /** @param {number} number @param {boolean} isBack */
  show(number, isBack = false) {
    const isNew = this.shown !== null && this.shown !== number && !isBack;
    this.shown = number;
    const step = this.steps[number - 1];
    this.select.selectedIndex = number - 1;
    for (const text of TEXTS) {
      const key = `lesson.${step.name}.${text}`;
      say(`lesson-${text}`, isKnown(key) ? phrase(key) : ""); // few steps have something to compute
    }
    for (const details of find("lesson").querySelectorAll("details")) details.open = false;
    this.markCharts(step.charts);
    find("lesson-table").replaceChildren(...makeTable(step));
    this.ask(step);
    this.prepare(step);
    this.field.value = this.predictions[number] ?? "";
    find("step-back", HTMLButtonElement).disabled = number === 1;
    find("step-next", HTMLButtonElement).disabled = number === this.steps.length;
    this.offerActs(step);
    // A step is an entry of the history: Back is the step before.
    remember({}, `#lesson=${number}`, isNew);
    this.send({ act: "rest" }); // nothing moves before the prediction
  }

  /** Ask for the number of a step, if it has one. @param {Step} step */
  ask({ name, ask }) {
    find("lesson-number").hidden = !ask;
    this.number.value = "";
    this.showAsked({ name, ask });
  }

  /** @param {Pick<Step, "name" | "ask">} step */
  showAsked({ name, ask }) {
    say("lesson-ask", ask ? phrase(`lesson.${name}.ask`, { within: writeWithin(ask) }) : "");
    say("lesson-checked", "");
  }

  /** The number is asked for in the unit of the page. */
  showUnit() {
    if (this.shown === null) return;
    convertTyped(this.number);
    this.showAsked(this.steps[this.shown - 1]);
  }

  check() {
    const { ask } = this.steps[this.current - 1];
    if (ask) say("lesson-checked", checkNumber(ask, this.number.value));
  }

  /** @param {string[]} names of the charts to look at, which come first */
  markCharts(names) {
    for (const chart of findAll("[data-chart]")) {
      const isNamed = names.includes(chart.dataset.chart ?? "");
      const details = /** @type {HTMLDetailsElement} */ (chart.closest("details"));
      details.classList.toggle("looked", isNamed);
      details.open = isNamed;
    }
    find("charts").scrollTop = 0;
  }

  /** @param {Step} step */
  offerActs({ name, acts, scene }) {
    this.hurries = [];
    const buttons = acts.map((act, k) => {
      const text = phrase(`lesson.${name}.act_${k + 1}`);
      const isFirst = Boolean(act.start || act.run);
      const button = make("button", { disabled: !isFirst, "aria-label": text });
      write(button, text);
      if (!isFirst) this.hurries.push(button);
      button.addEventListener("click", () => this.do(act, scene));
      return button;
    });
    find("lesson-acts").replaceChildren(...buttons);
  }

  /** @param {Act} act @param {string} scene */
  do(act, scene) {
    if (act.start) this.isAwaited = true;
    this.send(nameAct(act, scene));
    if (act.start) this.send({ act: "run" });
  }

  /**
   * A hurry is that of the step only after a start of the step, and only once: a Reset makes it
   * possible again.
   * @param {import("../words/facts.js").Facts} facts
   */
  follow({ isFresh, link }) {
    const step = this.shown ?? 0;
    if (isFresh && this.isAwaited) remember({ begun: { step, link } });
    if (isFresh) this.isAwaited = false;
    const { begun } = recall();
    const isOfStep = isFresh && begun?.step === step && begun.link === link;
    for (const button of this.hurries) button.disabled = !isOfStep;
  }
}
