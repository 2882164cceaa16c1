// What is drawn in the scene, and the legend of it.

import { COLORS, LEGEND } from "../scene/colors.js";
import { find, findAll, make } from "./document.js";
import { typeset } from "../words/typeset.js";

/** @typedef {(message: {[name: string]: any}) => void} Send */

/** A mark in the colour of a part of the scene. @param {keyof typeof COLORS} name */
const createMark = (name) => {
  const mark = make("i");
  mark.style.background = COLORS[name];
  return mark;
};

export class Layers {
  /** @param {Send} send */
  constructor(send) {
    this.send = send;
    /** @type {{[layer: string]: boolean}} */
    this.first = {};
    /** @type {{[layer: string]: HTMLInputElement}} */
    this.boxes = {};
    for (const [name, text, layer] of LEGEND) {
      const entry = make("li", {}, createMark(name), ...typeset(text));
      entry.dataset.layer = layer;
      find("legend").append(entry);
    }
  }

  /** @param {{[layer: string]: boolean}} layers and whether they are shown at first */
  offer(layers) {
    this.first = layers;
    for (const [layer, checked] of Object.entries(layers)) {
      const box = make("input", { type: "checkbox", checked, "aria-label": layer });
      this.boxes[layer] = box;
      box.addEventListener("change", () => this.show(layer, box.checked));
      const marks = LEGEND.filter(([, , own]) => own === layer).map(([name]) => createMark(name));
      find("layers").append(
        make("div", {}, make("label", {}, box, ...typeset(` ${layer} `), ...marks)),
      );
      this.mark(layer, checked);
    }
  }

  /** @param {string} layer @param {boolean} shown */
  show(layer, shown) {
    this.boxes[layer].checked = shown;
    this.mark(layer, shown);
    this.send({ act: "show", layer, shown });
  }

  /** The legend has what is drawn. @param {string} layer @param {boolean} shown */
  mark(layer, shown) {
    for (const entry of findAll(`#legend [data-layer="${layer}"]`)) entry.hidden = !shown;
  }

  /** Of the layers that are hidden at first show those that are named. @param {string[]} named */
  choose(named) {
    for (const [layer, isFirst] of Object.entries(this.first)) {
      const wanted = named.includes(layer);
      if (!isFirst && this.boxes[layer].checked !== wanted) this.show(layer, wanted);
    }
  }
}
