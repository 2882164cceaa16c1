// Labels of the scene: elements over the picture, each in the colour of its arrow.

import { make, write } from "../controls/document.js";

/** @import { Vector } from "../physics/kernel.js" */

const GAP = 2; // px between labels

export class Labels {
  /** @param {HTMLElement} place @param {import("./camera.js").Camera} camera */
  constructor(place, camera) {
    this.place = place;
    this.camera = camera;
    /** @type {{[name: string]: HTMLElement}} */
    this.names = {};
    /**
     * Places of the labels of this picture, in px, and on which side of them the labels stand.
     * @type {Map<string, {x: number, y: number, side: [number, number]}>}
     */
    this.shown = new Map();
    /** Sizes of the labels in px, once they are known. @type {Map<string, [number, number]>} */
    this.sizes = new Map();
  }

  begin() {
    this.shown.clear();
  }

  /**
   * Put a label at a point, on the side that is farther from another: it covers no arrow from there.
   * @param {string} name
   * @param {string} color
   * @param {Vector} point
   * @param {Vector} from
   * @param {string} text
   */
  put(name, color, point, from, text) {
    const [at, other] = [point, from].map((each) => this.camera.project(each));
    if (!at || !other) return;
    const label = this.find(name, color);
    if (label.dataset.text !== text) this.sizes.delete(name);
    write(label, text);
    const [x, y] = [at.x - other.x, at.y - other.y];
    const length = Math.max(Math.abs(x), Math.abs(y)) || 1; // of the larger half the label is clear
    this.shown.set(name, { x: at.x, y: at.y, side: [x / length, y / length] });
  }

  /** @param {string} name @param {string} color */
  find(name, color) {
    if (!this.names[name]) {
      this.names[name] = make("span", { className: "label", style: `border-color: ${color}` });
      this.place.append(this.names[name]);
    }
    return this.names[name];
  }

  /** @param {string} name @returns {[number, number]} */
  measure(name) {
    const known = this.sizes.get(name);
    if (known) return known;
    const { offsetWidth, offsetHeight } = this.names[name];
    if (offsetWidth) this.sizes.set(name, [offsetWidth, offsetHeight]);
    return [offsetWidth, offsetHeight];
  }

  /** Move each label to its side of its place, by half of its size. */
  step() {
    for (const [name, place] of this.shown) {
      const [width, height] = this.measure(name);
      const [x, y] = place.side;
      place.x += x * (width / 2 + GAP);
      place.y += y * (height / 2 + GAP);
      this.keepInside(name, place);
    }
  }

  /** Move each label down, from the highest on, until it covers none above it. */
  separate() {
    const done = [];
    for (const [name, place] of [...this.shown].sort(([, a], [, b]) => a.y - b.y)) {
      const [width, height] = this.measure(name);
      for (const other of done) {
        const isBeside = Math.abs(other.x - place.x) * 2 >= width + other.width;
        if (!isBeside) place.y = Math.max(place.y, other.y + (height + other.height) / 2 + GAP);
      }
      done.push({ ...place, width, height });
    }
  }

  /** None leaves the picture. @param {string} name @param {{x: number, y: number}} place */
  keepInside(name, place) {
    const [width, height] = this.measure(name);
    const { size } = this.camera;
    place.x = Math.max(Math.min(place.x, size.width - width / 2), width / 2);
    place.y = Math.max(Math.min(place.y, size.height - height / 2), height / 2);
  }

  /** Place the labels of this picture, and hide the others. */
  end() {
    for (const [name, label] of Object.entries(this.names)) label.hidden = !this.shown.has(name);
    this.step();
    this.separate();
    for (const [name, { x, y }] of this.shown) {
      const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      this.names[name].style.transform = `${place} translate(-50%, -50%)`;
    }
  }
}
