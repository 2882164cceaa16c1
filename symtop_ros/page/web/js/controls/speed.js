// The speed of the motion, as a share of real time.

import { find, make } from "./document.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

const PARTS = [2, 5, 10, 20, 50, 100];

/** The list of speeds, in which others than these appear once they hold. */
export class SpeedList {
  /** @param {(factor: number) => void} choose */
  constructor(choose) {
    this.list = find("speed", HTMLSelectElement);
    for (const part of PARTS) this.add(1 / part, `1/${part}`);
    this.list.addEventListener("change", () => choose(Number(this.list.value)));
  }

  /** @param {number} value @param {string} factor */
  add(value, factor) {
    this.list.append(make("option", { value, textContent: phrase("speed.part", { factor }) }));
  }

  /** @param {number} factor */
  show(factor) {
    const isListed = [...this.list.options].some((option) => Number(option.value) === factor);
    if (!isListed) this.add(factor, shorten(factor, 3));
    if (document.activeElement !== this.list) this.list.value = String(factor);
  }
}
