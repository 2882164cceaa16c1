// The speed of the motion, as a share of real time.

import { find, make } from "./document.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

const SPEEDS = [1, ...[2, 5, 10, 20, 50, 100].map((n) => 1 / n)];

/** The list of speeds, in which others than these appear once they hold. */
export class SpeedList {
  /** @param {(factor: number) => void} choose */
  constructor(choose) {
    this.list = find("speed", HTMLSelectElement);
    for (const speed of SPEEDS)
      this.add(
        speed,
        speed === 1
          ? phrase("speed.real")
          : phrase("speed.part", { factor: `1/${Math.round(1 / speed)}` }),
      );
    this.list.addEventListener("change", () => choose(Number(this.list.value)));
  }

  /** @param {number} value @param {string} textContent */
  add(value, textContent) {
    this.list.append(make("option", { value, textContent }));
  }

  /** @param {number} factor */
  show(factor) {
    const isListed = [...this.list.options].some((option) => Number(option.value) === factor);
    if (!isListed) this.add(factor, phrase("speed.part", { factor: shorten(factor, 3) }));
    if (document.activeElement !== this.list) this.list.value = String(factor);
  }
}
