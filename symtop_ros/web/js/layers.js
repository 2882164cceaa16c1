// What is drawn in the scene, and the legend of it.

import { find, findAll, make } from "./document.js";

/** @typedef {(message: {[name: string]: any}) => void} Send */

const TORQUES = "fictitious torques";
const LEGEND = [
  ["#0a46be", "L, angular momentum", ""],
  ["#009e73", "omega", ""],
  ["#d53c0a", "torque", ""],
  ["#e69600", "trace", ""],
  ["#c9ced6", "pale: ghost, not kicked", ""],
  ["#d53c0a", "gravity", TORQUES],
  ["#1e96f0", "Coriolis", TORQUES],
  ["#690fff", "centrifugal", TORQUES],
  ["#d23ca5", "sum, Ix theta''", TORQUES],
];

export class Layers {
  /** @param {Send} send */
  constructor(send) {
    this.send = send;
    /** @type {{[layer: string]: boolean}} */
    this.first = {};
    /** @type {{[layer: string]: HTMLInputElement}} */
    this.boxes = {};
    for (const [color, text, layer] of LEGEND) {
      const mark = make("i");
      mark.style.background = color;
      const entry = make("li", { hidden: Boolean(layer) }, mark, text);
      entry.dataset.layer = layer;
      find("legend").append(entry);
    }
  }

  /** @param {{[layer: string]: boolean}} layers and whether they are shown at first */
  offer(layers) {
    this.first = layers;
    for (const [layer, checked] of Object.entries(layers)) {
      const box = make("input", { type: "checkbox", checked });
      this.boxes[layer] = box;
      box.addEventListener("change", () => this.show(layer, box.checked));
      find("layers").append(make("div", {}, make("label", {}, box, ` ${layer}`)));
    }
  }

  /**
   * @param {string} layer
   * @param {boolean} shown
   */
  show(layer, shown) {
    this.boxes[layer].checked = shown;
    for (const entry of findAll(`#legend [data-layer="${layer}"]`)) entry.hidden = !shown;
    this.send({ act: "show", layer, shown });
  }

  /** Of the layers that are hidden at first show those that are named. @param {string[]} named */
  choose(named) {
    for (const [layer, isFirst] of Object.entries(this.first)) {
      const wanted = named.includes(layer);
      if (!isFirst && this.boxes[layer].checked !== wanted) this.show(layer, wanted);
    }
  }
}
