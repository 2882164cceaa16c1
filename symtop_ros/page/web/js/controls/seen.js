// A start from what is seen: a tilt and the time of one turn, a dip, constants of the motion. All starts
// that have it are buttons.

import { find, make, say, write } from "./document.js";
import { refuse, refuseField } from "./notices.js";
import { convertTyped, makeInput, readTyped } from "./typed.js";
import { BALANCE } from "../physics/balance.js";
import { NAMES } from "../physics/records.js";
import {
  addUnit,
  halveLastDigit,
  inDegrees,
  nameUnit,
  parseQuantity,
  writeLimit,
  writeRounded,
} from "../words/quantities.js";
import { speakText } from "../words/spoken.js";
import { QUANTITIES, UNITS } from "../words/units.js";
import { phrase } from "../words/wording.js";

/** @import { Found } from "../physics/kernel.js" */
/** @typedef {{theta: number, theta_dot: number, phi_dot: number, psi_dot: number, Mgl?: number}} Solution with Mgl if that was asked for */

const PER_MINUTE = 30 / Math.PI; // turns, of rad/s

/** @param {Solution} start */
const describe = (start) => {
  const variant = inDegrees() ? "degrees" : "radians";
  const turns = { spin: start.psi_dot * PER_MINUTE, theta_dot: start.theta_dot || null };
  const text = phrase("solution", { ...start, ...turns }, variant);
  return start.Mgl === undefined ? text : `${phrase("solution_weight", start)} ${text}`;
};

/** @typedef {{start: Solution, least: Solution, most: Solution}} Spread */
/** @type {[keyof Solution, string, string][]} */
const NUMBERS = [
  ["theta", "theta", "rad"],
  ["theta_dot", "theta'", "rad/s"],
  ["phi_dot", "phi'", "rad/s"],
  ["psi_dot", "psi'", "rad/s"],
  ["Mgl", "Mgl", "J"],
];

/** Two ends, rounded outwards at the second digit of their distance. @param {number} least @param {number} most @param {string} unit */
const writeEnds = (least, most, unit) => {
  const [size, width] = [Math.max(-least, most), most - least].map((each) =>
    Math.floor(Math.log10(each)),
  );
  const digits = Math.min(15, Math.max(2, size - width + 2));
  const [low, high] = [writeRounded(least, -1, unit, digits), writeRounded(most, 1, unit, digits)];
  return { least: low, most: high, unit: nameUnit(unit) };
};

/** How far the numbers of a start move for the last digits of what was typed. @param {Spread} spread */
const describeSpread = ({ least, most }) => {
  if (Number.isNaN(least.theta)) return phrase("spread.unknown");
  const numbers = NUMBERS.flatMap(([name, symbol, unit]) => {
    const [low, high] = [least[name] ?? 0, most[name] ?? 0];
    return high > low
      ? [phrase("spread.number", { name: symbol, ...writeEnds(low, high, unit) })]
      : [];
  });
  return numbers.length ? phrase("spread.numbers", { numbers: numbers.join(", ") }) : "";
};

/**
 * The words of a demand: some have one limit or two.
 * @param {string} demand @param {number} least @param {number} most
 */
const nameDemand = (demand, least, most) => {
  if (demand === "positive" && Number.isFinite(most)) return "most";
  return demand === "range" && Number.isNaN(least) ? "below" : demand;
};

export class Seen {
  /** @param {(message: import("../run/acts.js").Message) => void} send */
  constructor(send) {
    this.send = send;
    this.list = find("questions", HTMLSelectElement);
    for (const question of [...NAMES.question, BALANCE])
      this.list.append(new Option(phrase(`question.${question}`), question));
    /** @type {HTMLInputElement[]} */
    this.inputs = [];
    /** @type {HTMLElement[]} */
    this.labels = [];
    this.list.addEventListener("change", () => this.ask());
    find("solve").addEventListener("click", () => this.solve());
    find("known").addEventListener("keydown", ({ key }) => {
      if (key === "Enter") this.solve();
    });
    this.ask();
  }

  get names() {
    return this.list.value.split(" ");
  }

  /** Offer a field for each number of the question. */
  ask() {
    const rows = this.names.map((name) => {
      const input = makeInput({ id: `known-${name}` });
      const label = make("label", { htmlFor: input.id });
      return { input, label, row: make("div", { className: "field" }, label, input) };
    });
    this.inputs = rows.map(({ input }) => input);
    this.labels = rows.map(({ label }) => label);
    find("known").replaceChildren(...rows.map(({ row }) => row));
    this.writeLabels();
    this.clear();
  }

  writeLabels() {
    this.names.forEach((name, k) => {
      const text = addUnit(phrase(`known.${name}`), QUANTITIES[name]);
      write(this.labels[k], text);
      this.inputs[k].ariaLabel = speakText(text);
      this.inputs[k].dataset.name = text;
    });
  }

  showUnit() {
    this.writeLabels();
    for (const [k, input] of this.inputs.entries())
      if (QUANTITIES[this.names[k]] === "rad") convertTyped(input);
    this.clear();
  }

  clear() {
    find("solutions").replaceChildren();
    say("solutions-text", "");
  }

  solve() {
    refuse("");
    this.clear();
    const known = this.names.map((name, k) => readTyped(this.inputs[k], QUANTITIES[name]));
    if (known.every((each) => each !== null))
      this.send({ act: "solve", question: this.list.value, known, halfWidths: this.halve() });
  }

  /** Half a unit of the last digit of each number that was typed, in SI; 0 of what is exact. */
  halve() {
    return this.names.map((name, k) => {
      const half = halveLastDigit(this.inputs[k].value);
      return half === null ? 0 : parseQuantity(half, UNITS[QUANTITIES[name]]);
    });
  }

  /** Start a solution, with its own moment of gravity if it has one. @param {Solution} solution */
  begin({ Mgl, ...start }) {
    if (Mgl !== undefined) this.send({ act: "set", name: "top.Mgl", value: Mgl });
    this.send({ act: "start", ...start });
  }

  /** Show all starts as buttons, or say what a number would have to be. @param {Found} found */
  show({ demand, which, least, most, starts }) {
    if (demand) {
      const input = this.inputs[which];
      const unit = QUANTITIES[this.names[which]];
      const limits = { least: writeLimit(least, 1, unit), most: writeLimit(most, -1, unit) };
      const kind = nameDemand(demand, least, most);
      const name = phrase(`known.${this.names[which]}`);
      refuseField(input, phrase("demand", { kind, name, ...limits, got: input.value }));
      return;
    }
    say("solutions-text", phrase("page.solutions"));
    const shown = starts.flatMap((/** @type {Spread} */ found) => {
      const button = make("button", { className: "found" });
      write(button, describe(found.start));
      button.addEventListener("click", () => this.begin(found.start));
      const spread = make("p", { className: "dim spread" });
      write(spread, describeSpread(found));
      return [button, spread];
    });
    find("solutions").replaceChildren(...shown);
  }
}
