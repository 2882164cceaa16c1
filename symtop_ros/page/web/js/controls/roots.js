// Buttons that start the regular precessions at the tilt and the spin that are shown.

import { findAll, say } from "./document.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Now } from "../words/facts.js" */

export class Roots {
  /** @param {(message: import("../run/acts.js").Message) => void} send */
  constructor(send) {
    /** What is shown. @type {Now | null} */
    this.now = null;
    this.buttons = findAll("[data-precession]");
    for (const button of this.buttons) {
      const { precession } = button.dataset;
      button.addEventListener("click", () => {
        const { theta, psi_dot } = /** @type {Now} */ (this.now);
        send({ act: "start", theta, psi_dot, precession });
      });
    }
  }

  /** The buttons stay, so that none is replaced while it is pressed. @param {Now} now */
  show(now) {
    this.now = now;
    const { roots, elsewhere } = now;
    const names = roots.length === 2 ? ["slow", "fast"] : ["only"];
    say("roots-text", phrase(roots.length ? "roots.some" : "roots.none"));
    say("roots-elsewhere", elsewhere ? phrase("elsewhere", elsewhere) : "");
    this.buttons.forEach((button, k) => {
      button.hidden = k >= roots.length;
      if (button.hidden) return;
      const turn = roots[k] ? (2 * Math.PI) / Math.abs(roots[k]) : null;
      button.textContent = phrase(`roots.${names[k]}`, { rate: shorten(roots[k]), turn });
    });
  }
}
