// The top as parts on a light axle, which a class can weigh and measure: points, rods, hoops, discs
// and balls. The list is a body when its button is pressed; until then it follows the top.

import { find, make, write } from "./document.js";
import { refuse } from "./notices.js";
import { makeInput, readTyped } from "./typed.js";
import { NAMES } from "../physics/records.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Part, Top } from "../physics/kernel.js" */
/** @import { Facts } from "../words/facts.js" */
/** @typedef {{[name: string]: Part[]}} Bodies of the classroom */

const POINT = "point"; // without a size
const DIGITS = 6;
/** What is typed of a part, and its unit. @type {["mass" | "size" | "distance", string][]} */
const COLUMNS = [
  ["mass", "kg"],
  ["size", "m"],
  ["distance", "m"],
];

/** A row of the list. */
class Row {
  /** @param {Part} part @param {Parts} list */
  constructor(part, list) {
    this.kind = make("select", { "aria-label": phrase("part.kind") });
    for (const kind of NAMES.part_kind)
      this.kind.append(new Option(phrase(`part.${kind}`), kind, false, kind === part.kind));
    this.inputs = COLUMNS.map(([name]) => {
      const shown = shorten(part[name], DIGITS);
      const label = phrase(`part.${name}`);
      return makeInput({ value: shown, "aria-label": label });
    });
    const words = { className: "remove", "aria-label": phrase("part.remove") };
    const remove = make("button", words, "\u00d7");
    remove.addEventListener("click", () => list.remove(this));
    this.element = make("div", { className: "part" }, this.kind, ...this.inputs, remove);
    this.kind.addEventListener("change", () => this.followKind());
    this.element.addEventListener("input", () => list.change());
    this.element.addEventListener("keydown", ({ key, target }) => {
      if (key === "Enter" && target instanceof HTMLInputElement) list.use();
    });
    this.followKind();
  }

  followKind() {
    const [, size] = this.inputs;
    size.disabled = this.kind.value === POINT;
    if (size.disabled) size.value = "";
  }

  /** The part; null if a number of it is refused. @returns {Part | null} */
  read() {
    const kind = this.kind.value;
    const [mass, size, distance] = COLUMNS.map(([name, unit], k) => {
      if (name === "size" && kind === POINT) return 0;
      return readTyped(this.inputs[k], unit, name !== "distance");
    });
    return mass === null || size === null || distance === null
      ? null
      : { kind, mass, size, distance };
  }
}

export class Parts {
  /**
   * @param {(message: import("../run/acts.js").Message) => void} send
   * @param {Bodies} bodies
   */
  constructor(send, bodies) {
    this.send = send;
    /** @type {Row[]} */
    this.rows = [];
    this.isTyped = false; // and not yet used
    /** Of the body that the top is, in kg; NaN if there is none. @type {number} */
    this.mass = NaN;
    this.place = find("parts");
    /** The list that was used last. @type {Part[] | null} */
    this.used = null;
    this.offer(bodies);
    find("add-part").addEventListener("click", () => {
      this.change();
      this.fill([
        ...this.rows,
        new Row({ kind: POINT, mass: NaN, size: NaN, distance: NaN }, this),
      ]);
    });
    find("use-body").addEventListener("click", () => this.use());
  }

  /** @param {Bodies} bodies */
  offer(bodies) {
    const list = find("bodies", HTMLSelectElement);
    list.append(new Option(phrase("page.bodies"), ""));
    for (const name of Object.keys(bodies)) list.append(new Option(phrase(`body.${name}`), name));
    list.addEventListener("change", () => {
      if (!list.value) return;
      this.list(bodies[list.value]);
      list.value = "";
      this.use();
    });
  }

  /** The list differs from the body of the top until it is used. */
  change() {
    this.isTyped = true;
    write(find("parts-text"), phrase("page.parts_typed"));
  }

  /** @param {Part[]} parts */
  list(parts) {
    this.fill(parts.map((part) => new Row(part, this)));
  }

  /** @param {Row[]} rows */
  fill(rows) {
    this.rows = rows;
    this.place.replaceChildren(...rows.map(({ element }) => element));
  }

  /** @param {Row} row */
  remove(row) {
    this.change();
    this.fill(this.rows.filter((each) => each !== row));
  }

  /** Make the top that of the list. */
  use() {
    refuse("");
    const parts = this.rows.map((row) => row.read());
    if (!parts.every((part) => part !== null)) return;
    this.used = parts;
    this.isTyped = false;
    this.send({ act: "body", parts });
  }

  /**
   * Follow the top: the list that made it stays, for another one there is the disc that moves as it.
   * @param {Facts} facts @param {(parts: Part[]) => {mass: number, top: Top}} findBody
   */
  show({ body, weighed, disc: [mass, size, distance] }, findBody) {
    const own = this.used && findBody(this.used);
    const isOwn = own && String(Object.values(own.top)) === String([body.Ix, body.Iz, body.Mgl]);
    this.mass = isOwn ? own.mass : mass;
    if (this.isTyped) return;
    const disc = weighed.mass ? "page.parts_weighed" : "page.parts_disc";
    const about = isOwn ? "page.parts_own" : mass ? disc : "page.parts_none";
    write(find("parts-text"), phrase(about, { mass: shorten(weighed.mass, 3) }));
    if (isOwn) return;
    this.used = null;
    if (!this.place.contains(document.activeElement))
      this.list(Number.isFinite(mass) ? [{ kind: "disc", mass, size, distance }] : []);
  }
}
