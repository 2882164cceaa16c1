// Labels of the scene: words over the picture, each in the colour of what it names, with a line to it
// if they do not stand next to it.

import { find, make, write } from "../controls/document.js";
import { add } from "./matrices.js";

/** @import { Vector } from "../physics/kernel.js" */
/**
 * A label of the picture, in px: what it names, the middle of the label, and on which side it stands, how
 * far off. @typedef {{at: {x: number, y: number}, x: number, y: number, side: [number, number], lead: number}} Place
 */

const GAP = 2; // px between labels
const NEAR = 8; // px; so near a label needs no line

/** A label by its middle and its size, in px. @typedef {{x: number, y: number, width: number, height: number}} Box */

/** Move each label down, from the highest on, until it covers none above it. @param {Box[]} boxes */
const separate = (boxes) => {
  /** @type {Box[]} */
  const done = [];
  for (const box of boxes.sort((a, b) => a.y - b.y)) {
    for (const other of done) {
      const isBeside = Math.abs(other.x - box.x) * 2 >= box.width + other.width;
      if (!isBeside) box.y = Math.max(box.y, other.y + (box.height + other.height) / 2 + GAP);
    }
    done.push(box);
  }
};

/**
 * Move labels into a picture, and apart: what was moved below its lower edge goes up again.
 * @param {Box[]} boxes @param {{width: number, height: number}} size of the picture in px
 */
export const arrange = (boxes, { width, height }) => {
  const clip = (
    /** @type {number} */ middle,
    /** @type {number} */ long,
    /** @type {number} */ all,
  ) => Math.max(Math.min(middle, all - long / 2), long / 2);
  for (const box of boxes) {
    box.x = clip(box.x, box.width, width);
    box.y = clip(box.y, box.height, height);
  }
  separate(boxes);
  for (const box of boxes) box.y = height - box.y;
  for (const box of boxes) box.y = clip(box.y, box.height, height);
  separate(boxes);
  for (const box of boxes) box.y = height - box.y;
};

export class Labels {
  /** @param {HTMLElement} place @param {import("./camera.js").Camera} camera */
  constructor(place, camera) {
    this.place = place;
    this.camera = camera;
    /** @type {{[name: string]: {label: HTMLElement, line: HTMLElement}}} */
    this.names = {};
    /** The labels of this picture. @type {Map<string, Place>} */
    this.shown = new Map();
    /** Sizes of the labels in px, once they are known. @type {Map<string, [number, number]>} */
    this.sizes = new Map();
    /** What no label covers: the ball. @type {Box[]} */
    this.free = [];
    this.floor = 0; // px at the lower edge of the picture, which have other words
    const legend = find("legend");
    new ResizeObserver(() => {
      const isOver = getComputedStyle(legend).position === "absolute";
      this.floor = isOver ? legend.offsetHeight : 0;
    }).observe(legend);
  }

  begin() {
    this.shown.clear();
    this.free = [];
  }

  /** Keep a ball free of labels. @param {Vector} point @param {number} radius */
  keepFree(point, radius) {
    const [at, above] = [point, add(point, [0, 0, radius])].map((each) =>
      this.camera.project(each),
    );
    if (!at || !above) return;
    const size = 2 * Math.hypot(above.x - at.x, above.y - at.y);
    this.free.push({ x: at.x, y: at.y, width: size, height: size });
  }

  /**
   * Put a label at a point, on the side that is farther from another: it covers no arrow from there. Else
   * it stands at the right.
   * @param {string} name
   * @param {string} color
   * @param {Vector} point
   * @param {Vector | null} from
   * @param {string} text
   * @param {number} lead px from the point
   */
  put(name, color, point, from, text, lead = 0) {
    const at = this.camera.project(point);
    const other = from ? this.camera.project(from) : at;
    if (!at || !other) return;
    const { label } = this.find(name, color);
    if (label.dataset.text !== text) this.sizes.delete(name);
    write(label, text);
    const [x, y] = [at.x - other.x, at.y - other.y];
    const length = Math.max(Math.abs(x), Math.abs(y)); // of the larger half the label is clear
    /** @type {[number, number]} */
    const side = length > 1 ? [x / length, y / length] : [1, 0];
    this.shown.set(name, { at, x: at.x, y: at.y, side, lead });
  }

  /** @param {string} name @param {string} color */
  find(name, color) {
    if (!this.names[name]) {
      const style = `--named: ${color}`;
      const label = make("span", { className: "label", style });
      const line = make("i", { className: "leader", style });
      this.names[name] = { label, line };
      this.place.append(line, label);
    }
    return this.names[name];
  }

  /** @param {string} name @returns {[number, number]} */
  measure(name) {
    const known = this.sizes.get(name);
    if (known) return known;
    const { offsetWidth, offsetHeight } = this.names[name].label;
    if (offsetWidth) this.sizes.set(name, [offsetWidth, offsetHeight]);
    return [offsetWidth, offsetHeight];
  }

  /** Move each label to its side of its place, by half of its size. */
  step() {
    for (const [name, place] of this.shown) {
      const [width, height] = this.measure(name);
      const [x, y] = place.side;
      place.x += x * (width / 2 + GAP + place.lead);
      place.y += y * (height / 2 + GAP + place.lead);
      this.keepInside(name, place);
      this.leaveFree(name, place);
    }
  }

  /** A label over the ball goes to the nearer edge of it, up or down. @param {string} name @param {Place} place */
  leaveFree(name, place) {
    const [width, height] = this.measure(name);
    for (const { x, y, width: wide, height: high } of this.free) {
      if (Math.abs(place.x - x) * 2 >= width + wide || Math.abs(place.y - y) * 2 >= height + high)
        continue;
      const far = (height + high) / 2 + GAP;
      place.y = place.y < y && y - far > height / 2 ? y - far : y + far;
    }
  }

  separate() {
    const boxes = [...this.shown].map(([name, place]) => {
      const [width, height] = this.measure(name);
      return { x: place.x, y: place.y, width, height, place };
    });
    const { width, height } = this.camera.size;
    arrange(boxes, { width, height: height - this.floor });
    for (const { x, y, place } of boxes) Object.assign(place, { x, y });
  }

  /** None leaves the picture, and gives way to an arrow that ends there. @param {string} name @param {Place} place */
  keepInside(name, place) {
    const [width, height] = this.measure(name);
    const { size } = this.camera;
    const y = Math.max(Math.min(place.y, size.height - this.floor - height / 2), height / 2);
    const aside = Math.abs(y - place.y) > NEAR ? width / 2 + 2 * NEAR : 0;
    place.x = Math.max(Math.min(place.x + aside, size.width - width / 2), width / 2);
    place.y = y;
    const { at } = place;
    const isCovered =
      Math.abs(place.x - at.x) < width / 2 + NEAR && Math.abs(y - at.y) < height / 2;
    if (isCovered && place.lead) place.y = Math.max(at.y - height / 2 - 2 * NEAR, height / 2);
  }

  /** Place the labels of this picture, and hide the others. */
  end() {
    for (const [name, { label, line }] of Object.entries(this.names)) {
      label.hidden = !this.shown.has(name);
      line.hidden = true;
    }
    this.step();
    this.separate();
    for (const [name, place] of this.shown) {
      const { style } = this.names[name].label;
      style.transform = `${move(place)} translate(-50%, -50%)`;
      this.lead(name, place);
    }
  }

  /** Draw a line from what a label names to its edge. @param {string} name @param {Place} place */
  lead(name, { at, x, y }) {
    const [width, height] = this.measure(name);
    const [right, down] = [x - at.x, y - at.y];
    const inside = Math.min(width / 2 / Math.abs(right), height / 2 / Math.abs(down), 1);
    const length = Math.hypot(right, down) * (1 - inside);
    const { line } = this.names[name];
    line.hidden = length < NEAR;
    line.style.width = `${length.toFixed(1)}px`;
    line.style.transform = `${move(at)} rotate(${Math.atan2(down, right).toFixed(3)}rad)`;
  }
}

/** @param {{x: number, y: number}} place px */
const move = ({ x, y }) => `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
