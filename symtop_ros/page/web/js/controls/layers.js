// What is drawn in the scene: check boxes, the words that name an arrow, and the legend of torques.

import { ARROWS, COLORS, LAYERS, LEGEND } from "../scene/colors.js";
import { find, findAll, make } from "./document.js";
import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

/** @typedef {(message: import("../run/acts.js").Message) => void} Send */

const MOMENT = 3000; // ms

/** A mark in the colour of a part of the scene. @param {keyof typeof COLORS} name */
const createMark = (name) => make("i", { style: `background: ${COLORS[name]}` });

/** @param {[keyof typeof COLORS, string]} entry of the legend */
const createEntry = ([name, layer]) => {
  const text = phrase(`legend.${name}`);
  if (!ARROWS.some((arrow) => arrow === layer))
    return make("li", {}, createMark(name), ...typeset(text));
  return make("li", {}, ...typeset(`[${text}|${layer}]`));
};

/** The layer of the word that an event is about. @param {Event} event */
const findLayer = ({ target }) => {
  const word = target instanceof Element ? target.closest(".word") : null;
  return word instanceof HTMLElement ? (word.dataset.layer ?? null) : null;
};

export class Layers {
  /** @param {Send} send */
  constructor(send) {
    this.send = send;
    /** @type {{[layer: string]: boolean}} */
    this.first = {};
    /** @type {{[layer: string]: HTMLInputElement}} */
    this.boxes = {};
    this.flashing = 0;
    /** Layers that are shown in any case. @type {Set<string>} */
    this.forced = new Set();
    // What is drawn at first has its name in the scene, or needs none.
    for (const each of LEGEND.filter(([, layer]) => !LAYERS[layer])) {
      const entry = createEntry(each);
      entry.dataset.layer = each[1];
      find("legend").append(entry);
    }
    const { style } = document.documentElement;
    for (const name of ARROWS) style.setProperty(`--${name}`, COLORS[name]);
    this.listen();
  }

  /** Pointing at a word shows its arrow, and a click keeps it. */
  listen() {
    for (const begin of ["pointerover", "focusin"])
      document.addEventListener(begin, (event) => this.peek(findLayer(event), true));
    for (const end of ["pointerout", "focusout"])
      document.addEventListener(end, (event) => this.peek(findLayer(event), false));
    document.addEventListener("click", (event) => {
      const layer = findLayer(event);
      if (layer) this.show(layer, !this.boxes[layer].checked);
    });
  }

  /** Show arrows for a moment. @param {string[]} layers */
  flash(layers) {
    clearTimeout(this.flashing);
    for (const layer of layers) this.peek(layer, true);
    this.flashing = setTimeout(() => {
      for (const layer of layers) this.peek(layer, false);
    }, MOMENT);
  }

  /**
   * Show layers whatever is pointed at, until that is taken back; those that are chosen stay.
   * @param {string[]} layers @param {boolean} shown
   */
  force(layers, shown) {
    for (const layer of layers) {
      this.forced.delete(layer);
      this.peek(layer, shown);
      if (shown) this.forced.add(layer);
    }
  }

  /** Show an arrow for as long as its word is pointed at. @param {string | null} layer @param {boolean} shown */
  peek(layer, shown) {
    if (!layer || this.forced.has(layer)) return;
    if (layer in this.boxes && !this.boxes[layer].checked) this.send({ act: "show", layer, shown });
  }

  /** @param {{[layer: string]: boolean}} layers and whether they are shown at first */
  offer(layers) {
    this.first = layers;
    for (const [layer, checked] of Object.entries(layers)) {
      const name = phrase(`layer.${layer}`);
      const box = make("input", { type: "checkbox", checked, "aria-label": name });
      this.boxes[layer] = box;
      box.addEventListener("change", () => this.show(layer, box.checked));
      const marks = LEGEND.filter(([, own]) => own === layer).map(([name]) => createMark(name));
      find("layers").append(
        make("div", {}, make("label", {}, box, ...typeset(` ${name} `), ...marks)),
      );
      this.mark(layer, checked);
    }
  }

  /** @param {string} layer @param {boolean} shown */
  show(layer, shown) {
    this.boxes[layer].checked = shown;
    this.mark(layer, shown);
    if (this.forced.has(layer)) return;
    this.send({ act: "show", layer, shown });
  }

  /** The legend has the words of all arrows, and else what is drawn. @param {string} layer @param {boolean} shown */
  mark(layer, shown) {
    for (const entry of findAll(`#legend li[data-layer="${layer}"]`)) {
      const [word] = findAll(".word", entry);
      if (word) word.setAttribute("aria-pressed", String(shown));
      else entry.hidden = !shown;
    }
  }

  /** Of the layers that are hidden at first show those that are named. @param {string[]} named */
  choose(named) {
    for (const [layer, isFirst] of Object.entries(this.first)) {
      const wanted = named.includes(layer);
      if (!isFirst && this.boxes[layer].checked !== wanted) this.show(layer, wanted);
    }
  }
}
