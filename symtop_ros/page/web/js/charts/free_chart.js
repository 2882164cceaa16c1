// The chart whose axes the user chooses, with the values under the pointer, and a run that is kept
// for comparison.

import { nameQuantity, QUANTITIES } from "./axes_list.js";
import { keepChoice } from "../controls/choices.js";
import { find, make, moveByKeys, write } from "../controls/document.js";
import { draw, findSpan, Frame, WIDE } from "./plot.js";
import { drawMarks, placeMarks } from "./seen_points.js";
import { nameUnit, shorten, toUnit } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Sample } from "../run/telling.js" */
/** @import { Quantity } from "./axes_list.js" */
/** @import { Pair } from "./plot.js" */
/** @import { Mark, Marks } from "../run/marks.js" */
/** @typedef {"state" | "ghost" | "kept"} Whose */

const HEIGHT = 195;
/** @type {[Whose, string][]} */
const CURVES = [
  [
    "kept",
    'stroke="var(--kept)" stroke-width="1.6" stroke-dasharray="1 3" stroke-linecap="round" id="kept"',
  ],
  ["ghost", 'stroke="var(--grey)" stroke-width="1.5" stroke-dasharray="4 3"'],
  ["state", 'stroke="var(--phi)" stroke-width="1.8" id="chosen"'],
];

/** @param {Quantity} quantity @param {Sample} sample @param {Whose} whose */
const measure = ({ pick, unit }, { time, course, kept, ...states }, whose) => {
  const from = whose === "kept" ? kept : { state: states[whose], course };
  if (!from?.state) return NaN;
  const value = pick(time, from.state, from.course);
  return unit === "rad" ? toUnit(value) : value;
};

export class FreeChart {
  /** @param {(isKept: boolean) => void} keep the present run, or let the kept one go */
  constructor(keep) {
    this.x = this.offer("free-x", "theta");
    this.y = this.offer("free-y", "theta_dot");
    this.place = find("free-place", HTMLInputElement);
    moveByKeys(this.place);
    /** Points of the present curve in units of the drawing. @type {Pair[]} */
    this.points = [];
    this.isKept = false;
    const button = find("free-keep");
    button.addEventListener("click", () => {
      this.isKept = !this.isKept;
      write(button, phrase(this.isKept ? "page.free_discard" : "page.free_keep"));
      keep(this.isKept);
    });
    find("free").addEventListener("pointermove", (event) => this.follow(event));
  }

  /** @param {string} id @param {string} chosen */
  offer(id, chosen) {
    const list = find(id, HTMLSelectElement);
    for (const [value, { unit }] of Object.entries(QUANTITIES)) {
      list.append(make("option", { value, textContent: `${nameQuantity(value)} (${unit})` }));
    }
    list.value = chosen;
    keepChoice(id);
    return list;
  }

  /**
   * The sample that is nearest to the pointer is the one whose values are shown.
   * @param {PointerEvent} event
   */
  follow({ clientX, clientY }) {
    const { left, top, width } = find("free").getBoundingClientRect();
    const [x, y] = [clientX - left, clientY - top].map((each) => (each * WIDE) / width);
    const distances = this.points.map(([px, py]) => Math.hypot(px - x, py - y));
    const nearest = distances.reduce((best, each, k) => (each < distances[best] ? k : best), 0);
    this.place.value = String(nearest / Math.max(distances.length - 1, 1));
  }

  /** @param {Sample[]} samples @param {Mark[]} marks of measured points @param {Marks} all */
  draw(samples, marks, all) {
    const [horizontal, vertical] = [this.x, this.y].map((list) => QUANTITIES[list.value]);
    const placed = placeMarks(marks, [this.x.value, this.y.value], (mark) => {
      const seen = { ...mark, ghost: null, kept: null };
      return [measure(horizontal, seen, "state"), measure(vertical, seen, "state")];
    });
    const curves = CURVES.map(([whose, style]) => {
      const values = samples.map((each) => [
        measure(horizontal, each, whose),
        measure(vertical, each, whose),
      ]);
      return { style, values: /** @type {Pair[]} */ (values) };
    });
    const [range, edges] = [0, 1].map((k) =>
      findSpan(
        [...curves.flatMap(({ values }) => values), ...placed.map(({ point }) => point)].map(
          (each) => each[k],
        ),
        1e-6,
      ),
    );
    const frame = new Frame(HEIGHT, range, edges);
    const paths = curves.map(({ style, values }) => frame.curve(values, style));
    const own = curves[curves.length - 1].values;
    this.points = own.map((each) => frame.place(each));
    draw(
      "free",
      HEIGHT,
      `${frame.axes}${paths.join("")}${drawMarks("free", frame, all, placed)}
      ${frame.dot(own[this.findShown(samples)], 'fill="var(--theta)"')}
      ${frame.nameVertical(nameUnit(vertical.unit))}${frame.nameHorizontal(nameUnit(horizontal.unit))}`,
      phrase("chart.free", { up: nameQuantity(this.y.value), over: nameQuantity(this.x.value) }),
    );
  }

  /** The number of the sample whose values are shown. @param {Sample[]} samples */
  findShown(samples) {
    return Math.round(Number(this.place.value) * (samples.length - 1));
  }

  /** The values at the dot. @param {Sample[]} samples */
  write(samples) {
    const sample = samples[this.findShown(samples)];
    const texts = [this.x, this.y].map((list) => {
      const quantity = QUANTITIES[list.value];
      const value = measure(quantity, sample, "state");
      return `${nameQuantity(list.value)} ${shorten(value, 5)} ${nameUnit(quantity.unit)}`;
    });
    write(find("free-values"), texts.join(", "));
    this.place.setAttribute("aria-valuetext", texts.join(", "));
  }
}
