// Fields of numbers: a value is taken over on Enter or when the field is left, never while it is
// typed, and nothing is written into a field that has the focus. Tilt and rates follow the motion, and
// are those of the start while one of them is edited. Behind the digits of a field is a double: who
// types these digits again means it.

import { NAMES } from "../physics/records.js";
import { findAll, make, stepByKeys, whenReleased, write } from "./document.js";
import { acceptField, refuse, refuseField } from "./notices.js";
import {
  addUnit,
  findReadings,
  inDegrees,
  parseQuantity,
  shorten,
  writeLimit,
} from "../words/quantities.js";
import { speakText } from "../words/spoken.js";
import { UNITS } from "../words/units.js";
import { phrase } from "../words/wording.js";

/**
 * A field; low, high and step are those of its slider.
 * @typedef {{isAngle?: boolean, isRate?: boolean, isPositive?: boolean,
 *   isNotNegative?: boolean, low?: number, high?: number, step?: number}} Field
 */

/** @type {string[]} */
const FRICTION = NAMES.friction_kind;
/** @type {{[name: string]: Field}} */
const FIELDS = {
  factor: { isPositive: true, low: 1.05, high: 3, step: 0.05 },
  theta: { isAngle: true, low: 0, high: Math.PI, step: 0.01 },
  psi_dot: { isRate: true, low: -400, high: 400, step: 1 },
  phi_dot: { isRate: true, low: -12, high: 12, step: 0.1 },
  "top.Ix": { isPositive: true },
  "top.Iz": { isPositive: true },
  "top.Mgl": {},
  ...Object.fromEntries(FRICTION.map((name) => [`friction.${name}`, { isNotNegative: true }])),
};
const DIGITS = 6; // of a field
const ROOT_DIGITS = 4; // of a regular rate on its button
const BETWEEN = 100; // ms; of the moves of a slider the last one in this time is sent
const REFUSED = 1000; // ms that a refused text stays after its field is left

const [SMALLEST, LARGEST] = [1e-100, 1e100]; // of what the kernel takes

/**
 * The bound of a top that a value breaks; no body has more about one axis than about the other two together.
 * @param {string} name @param {number} value @param {{[name: string]: number}} values of the other fields
 */
const checkTop = (name, value, { "top.Ix": Ix, "top.Iz": Iz }) => {
  const unit = name === "top.Mgl" ? "J" : "kg m^2";
  const least = (/** @type {number} */ limit) => writeLimit(limit, 1, unit);
  const most = (/** @type {number} */ limit) => writeLimit(limit, -1, unit);
  if (Math.abs(value) > LARGEST) return { kind: "size", most: most(LARGEST) };
  if (name === "top.Mgl") return null;
  if (value < SMALLEST) return { kind: "least", least: least(SMALLEST) };
  if (name === "top.Ix" && value < Iz / 2)
    return { kind: "least", least: least(Iz / 2), bound: "(Iz/2)" };
  if (name === "top.Iz" && value > 2 * Ix)
    return { kind: "at_most", most: most(2 * Ix), bound: "(2 Ix)" };
  return null;
};

/** A field in the page, with its text and its slider. */
class Entry {
  /** @param {HTMLElement} place @param {Fields} fields */
  constructor(place, fields) {
    this.name = place.dataset.field ?? "";
    this.field = FIELDS[this.name];
    this.fields = fields;
    const id = `field-${this.name}`;
    const label = phrase(`field.${this.name}`);
    this.title = label;
    this.label = make("label", { htmlFor: id });
    write(this.label, label);
    this.text = make("input", {
      id,
      type: "text",
      autocomplete: "off",
      "aria-label": speakText(label),
    });
    place.append(this.label, this.text);
    this.isTyped = false; // and not yet taken over
    this.value = NaN; // that was asked for last
    this.followText();
    /** @type {HTMLInputElement | null} */
    this.slider = null;
    this.isDragged = false;
    if (this.field.low !== undefined) this.addSlider(place);
  }

  /** What is shown for a value, as a share of it. */
  get scale() {
    return this.field.isAngle && inDegrees() ? 180 / Math.PI : 1;
  }

  /** Units that may be typed: those of an angle or a rate, or that of the label. */
  get units() {
    const { isAngle, isRate } = this.field;
    if (isAngle) return UNITS.rad;
    if (isRate) return UNITS["rad/s"];
    const own = this.title.match(/\((.+)\)$/)?.[1];
    return own ? (UNITS[own.replace("\u00b2", "^2")] ?? { [own]: 1 }) : {};
  }

  followText() {
    this.text.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.commit();
      if (event.key !== "Escape") return;
      event.preventDefault();
      this.cancel();
    });
    this.text.addEventListener("input", () => {
      this.isTyped = true;
    });
    this.text.addEventListener("focus", () => {
      if (!this.text.hasAttribute("aria-invalid")) this.showStart();
    });
    this.text.addEventListener("blur", () => {
      this.commit();
      setTimeout(() => this.write(), REFUSED);
    });
  }

  /** What is edited is the start. */
  showStart() {
    const value = this.fields.read(this.name);
    if (value !== undefined) this.text.value = shorten(value * this.scale, DIGITS);
  }

  cancel() {
    this.isTyped = false;
    refuse("");
    this.text.blur();
    this.write();
  }

  commit() {
    if (!this.isTyped) return;
    this.isTyped = false;
    const typed = this.text.value.trim();
    const shown = this.fields.listShown(this.name).find(([value, digits]) => {
      return shorten(value * this.scale, digits) === typed;
    });
    const readings = shown ? null : findReadings(typed);
    const value = shown?.[0] ?? parseQuantity(typed, this.units);
    const refusal = readings ? { kind: "clear", ...readings } : this.check(value);
    if (!refusal) this.fields.change(this.name, value);
    else {
      const got = typed || phrase("nothing");
      refuseField(this.text, phrase("refused", { name: this.title, ...refusal, got }));
    }
  }

  /** What a value must be, if it is not; otherwise null. @param {number} value */
  check(value) {
    const { isAngle, isRate, isPositive, isNotNegative } = this.field;
    if (!Number.isFinite(value)) return { kind: "number" };
    if (isAngle && !(value >= 0 && value <= Math.PI))
      return { kind: "angle", most: writeLimit(Math.PI, -1, "rad") };
    if (isPositive && !(value > 0)) return { kind: "positive" };
    if (isNotNegative && value < 0) return { kind: "not_negative" };
    if (isRate && Math.abs(value) > LARGEST)
      return { kind: "size", most: writeLimit(LARGEST, -1, "rad/s") };
    return this.name.startsWith("top.") ? checkTop(this.name, value, this.fields.values) : null;
  }

  /** @param {HTMLElement} place */
  addSlider(place) {
    const { low: min, high: max } = this.field;
    const slider = make("input", {
      type: "range",
      min,
      max,
      step: "any",
      "aria-label": speakText(this.title),
    });
    this.slider = slider;
    stepByKeys(slider, (steps) => this.move(steps));
    slider.addEventListener("input", () => this.drag());
    whenReleased(slider, () => {
      this.isDragged = false;
    });
    place.append(slider);
  }

  /** @param {number} steps of the slider */
  move(steps) {
    if (!this.slider) return;
    const { min, max } = this.slider;
    const value = Number(
      (this.fields.values[this.name] + steps * (this.field.step ?? 1)).toPrecision(12),
    );
    this.fields.change(this.name, Math.min(Math.max(value, Number(min)), Number(max)));
  }

  drag() {
    if (!this.slider) return;
    this.isDragged = true;
    const decimals = (this.field.step ?? 1) < 0.1 ? 3 : 1;
    const value = Math.min(
      Number(Number(this.slider.value).toFixed(decimals)),
      Number(this.slider.max),
    );
    this.text.value = shorten(value * this.scale, DIGITS);
    this.fields.later(() => this.fields.change(this.name, value));
  }

  write() {
    const value = this.fields.read(this.name);
    if (value === undefined) return;
    const shown = shorten(value * this.scale, DIGITS);
    if (document.activeElement !== this.text) {
      this.text.value = shown;
      this.text.removeAttribute("aria-invalid");
    }
    if (!this.slider || this.isDragged) return;
    this.slider.value = String(value);
    this.slider.setAttribute("aria-valuetext", shown);
  }

  showUnit() {
    if (!this.field.isAngle) return;
    const text = addUnit(this.title, "rad");
    write(this.label, text);
    this.text.ariaLabel = speakText(text);
    if (this.slider) this.slider.ariaLabel = speakText(text);
  }

  /** Let the slider reach some values on both sides. @param {number[]} reached */
  widen(reached) {
    const high = Math.ceil(1.15 * Math.max(...reached.map(Math.abs)));
    if (this.slider) Object.assign(this.slider, { min: -high, max: high });
  }
}

export class Fields {
  /** @param {(message: import("../run/acts.js").Message) => void} send */
  constructor(send) {
    this.send = send;
    /** @type {{[name: string]: number}} */
    this.values = { factor: 1.4 }; // of the last act
    /** @type {{[name: string]: number}} */
    this.now = {}; // tilt and rates of the motion
    /** @type {number[]} */
    this.roots = []; // at the last act
    /** @type {(() => void) | null} */
    this.last = null;
    const entries = findAll("[data-field]").map((place) => new Entry(place, this));
    /** @type {{[name: string]: Entry}} */
    this.entries = Object.fromEntries(entries.map((entry) => [entry.name, entry]));
    /** The field whose value was sent last. @type {Entry | null} */
    this.asked = null;
  }

  /** @param {string} name @param {number} value */
  change(name, value) {
    this.asked = this.entries[name];
    this.asked.value = value;
    acceptField(this.asked.text);
    if (name === "factor") {
      this.values.factor = value;
      this.asked.write();
    } else if (name.includes(".")) this.send({ act: "set", name, value });
    else {
      /** @type {{[name: string]: number}} */
      const { theta, phi_dot, psi_dot } = { ...this.values, [name]: value };
      this.send({ act: "start", theta, phi_dot, psi_dot });
    }
  }

  /** @param {() => void} act */
  later(act) {
    if (!this.last) {
      setTimeout(() => {
        this.last?.();
        this.last = null;
      }, BETWEEN);
    }
    this.last = act;
  }

  /** What was asked for has been done. */
  grant() {
    this.asked = null;
  }

  /**
   * What was asked for has been refused; returns the refusal with the name of the field. The rates
   * together make the angular velocity.
   * @param {string} refusal
   */
  markRefused(refusal) {
    if (!this.asked) return refusal;
    const { field, title: name, value, text } = this.asked;
    text.setAttribute("aria-invalid", "true");
    if (!field.isRate || !refusal.startsWith("angular_velocity")) return refusal;
    const got = `${value}: ${refusal}`;
    return phrase("refused", { kind: "smaller", name, got });
  }

  /** @param {import("../words/facts.js").Facts} facts */
  show({ start, top, roots }) {
    Object.assign(this.values, start, top);
    this.roots = roots;
    this.entries.psi_dot.widen([340, start.psi_dot]);
    this.entries.phi_dot.widen([
      10,
      start.phi_dot,
      ...roots.filter((rate) => Math.abs(rate) < 1e4),
    ]);
    for (const entry of Object.values(this.entries)) entry.write();
  }

  /** Follow the motion. @param {import("../words/facts.js").Now} now */
  follow({ theta, phi_dot, psi_dot }) {
    this.now = { theta, phi_dot, psi_dot };
    for (const name of Object.keys(this.now)) this.entries[name].write();
  }

  /** Whether the tilt or a rate is edited. */
  get isEdited() {
    const place = document.activeElement?.closest("[data-field]");
    return place instanceof HTMLElement && (place.dataset.field ?? "") in this.now;
  }

  /** What a field shows. @param {string} name @returns {number | undefined} */
  read(name) {
    return (this.isEdited ? undefined : this.now[name]) ?? this.values[name];
  }

  /**
   * The doubles of which digits are shown while a field is edited.
   * @param {string} name @returns {[value: number, digits: number][]}
   */
  listShown(name) {
    const roots = name === "phi_dot" ? this.roots : [];
    return [
      [this.values[name], DIGITS],
      ...roots.map((rate) => /** @type {[number, number]} */ ([rate, ROOT_DIGITS])),
    ];
  }

  showUnit() {
    for (const entry of Object.values(this.entries)) {
      entry.showUnit();
      entry.write();
    }
  }
}
