// Labels of the scene: elements over the picture, each in the colour of its arrow.

import { typeset } from "../words/typeset.js";

/** @import { Vector } from "../physics/kernel.js" */

const GAP = 2; // px between labels

export class Labels {
  /** @param {HTMLElement} place @param {import("./camera.js").Camera} camera */
  constructor(place, camera) {
    this.place = place;
    this.camera = camera;
    /** @type {{[name: string]: HTMLElement}} */
    this.names = {};
    /** Places of the labels of this picture, in px. @type {Map<string, {x: number, y: number}>} */
    this.shown = new Map();
    /** Sizes of the labels in px, once they are known. @type {Map<string, [number, number]>} */
    this.sizes = new Map();
  }

  begin() {
    this.shown.clear();
  }

  /** @param {string} name @param {string} color @param {Vector} point */
  put(name, color, point) {
    const at = this.camera.project(point);
    if (!at) return;
    this.find(name, color);
    this.shown.set(name, { x: at.x, y: at.y });
  }

  /** @param {string} name @param {string} color */
  find(name, color) {
    if (!this.names[name]) {
      const label = document.createElement("span");
      label.className = "label";
      label.append(...typeset(name));
      label.style.borderColor = color;
      this.place.append(label);
      this.names[name] = label;
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

  /** Place the labels of this picture, and hide the others. */
  end() {
    for (const [name, label] of Object.entries(this.names)) label.hidden = !this.shown.has(name);
    this.separate();
    for (const [name, { x, y }] of this.shown) {
      const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      this.names[name].style.transform = `${place} translate(-50%, -50%)`;
    }
  }
}
