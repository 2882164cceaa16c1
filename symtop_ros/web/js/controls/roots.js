// Buttons that start the regular precessions at the tilt and the spin that are shown.

import { find, make } from "./document.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @typedef {{theta: number, phi_dot: number, psi_dot: number, roots: number[]}} Now */

export class Roots {
  /** @param {(message: {[name: string]: any}) => void} send */
  constructor(send) {
    /** What is shown. @type {Now | null} */
    this.now = null;
    this.text = document.createTextNode("");
    this.buttons = ["slow", "fast"].map((precession) => {
      const button = make("button");
      button.addEventListener("click", () => {
        const { theta, psi_dot } = /** @type {Now} */ (this.now);
        send({ act: "start", theta, psi_dot, precession });
      });
      return button;
    });
    find("roots").append(this.text, ...this.buttons);
  }

  /** The buttons stay, so that none is replaced while it is pressed. @param {Now} now */
  show(now) {
    this.now = now;
    const { roots } = now;
    const names = roots.length === 2 ? ["slow", "fast"] : ["only"];
    this.text.data = phrase(roots.length ? "roots.some" : "roots.none");
    this.buttons.forEach((button, k) => {
      button.hidden = k >= roots.length;
      if (!button.hidden)
        button.textContent = phrase(`roots.${names[k]}`, { rate: shorten(roots[k]) });
    });
  }
}
