// A start from what is seen: a tilt and the time of one turn, a dip, constants of the motion. All starts
// that have it are buttons.

import { find, make, say, write } from "./document.js";
import { refuse } from "./notices.js";
import { readTyped } from "./typed.js";
import { NAMES } from "../physics/records.js";
import { inDegrees } from "../words/quantities.js";
import { QUANTITIES } from "../words/units.js";
import { phrase } from "../words/wording.js";

/** @import { Found } from "../physics/kernel.js" */
/** @typedef {{theta: number, theta_dot: number, phi_dot: number, psi_dot: number}} Solution */

const PER_MINUTE = 30 / Math.PI; // turns, of rad/s
const DIGITS = 5; // of a limit

/** @param {Solution} start */
const describe = (start) => {
  const variant = inDegrees() ? "degrees" : "radians";
  const turns = { spin: start.psi_dot * PER_MINUTE, theta_dot: start.theta_dot || null };
  return phrase("solution", { ...start, ...turns }, variant);
};

/**
 * A limit in few digits, rounded to the side that is allowed: one that is typed in again is not refused.
 * @param {number} limit @param {1 | -1} side of what is allowed
 */
const roundInwards = (limit, side) => {
  const near = Number(limit.toPrecision(DIGITS));
  if (!Number.isFinite(near) || side * (near - limit) >= 0) return near;
  const place = Math.floor(Math.log10(Math.abs(near))) - DIGITS + 1;
  return Number((near + side * 10 ** place).toPrecision(DIGITS));
};

export class Seen {
  /** @param {(message: import("../run/acts.js").Message) => void} send */
  constructor(send) {
    this.send = send;
    this.list = find("questions", HTMLSelectElement);
    for (const question of NAMES.question)
      this.list.append(new Option(phrase(`question.${question}`), question));
    /** @type {HTMLInputElement[]} */
    this.inputs = [];
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
      const text = phrase(`known.${name}`);
      const input = make("input", { type: "text", autocomplete: "off", id: `known-${name}` });
      input.ariaLabel = text;
      const label = make("label", { htmlFor: input.id });
      write(label, text);
      return { input, row: make("div", { className: "field" }, label, input) };
    });
    this.inputs = rows.map(({ input }) => input);
    find("known").replaceChildren(...rows.map(({ row }) => row));
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
      this.send({ act: "solve", question: this.list.value, known });
  }

  /** Show all starts as buttons, or say what a number would have to be. @param {Found} found */
  show({ demand, which, least, most, starts }) {
    if (demand) {
      const name = this.inputs[which]?.ariaLabel;
      const isBounded = demand === "positive" && Number.isFinite(most);
      const [unit, got] = [QUANTITIES[this.names[which]], this.inputs[which]?.value];
      const kind = isBounded ? "most" : demand;
      const limits = { least: roundInwards(least, 1), most: roundInwards(most, -1) };
      refuse(phrase("demand", { kind, name, ...limits, unit, got }));
      return;
    }
    say("solutions-text", phrase("page.solutions"));
    const buttons = starts.map((/** @type {Solution} */ start) => {
      const button = make("button", { className: "found" });
      write(button, describe(start));
      button.addEventListener("click", () => this.send({ act: "start", ...start }));
      return button;
    });
    find("solutions").replaceChildren(...buttons);
  }
}
