// The opening of a first visit: while the first question is read, the scene shows what gravity's torque
// does to L, and then the way along which the axle would be pushed. It can be skipped. Who prefers no motion
// sees all of it at once.

import { CHANGE, WAY } from "../scene/colors.js";
import { keep, read } from "./choices.js";
import { find } from "./document.js";

const KEPT = "opening"; // as the browser keeps it: it is shown once
const SPEED = 0.015; // of real time: tilt and torque are seen from the side all the while
const LENGTH = 0.105; // s of the run, 7 s of the clock
const SHOWN = ["torque", "L", CHANGE];

export class Opening {
  /**
   * @param {(layers: string[], shown: boolean) => void} show
   * @param {(most: number) => void} limit the speed
   */
  constructor(show, limit) {
    this.show = show;
    this.limit = limit;
    this.isOn = false;
    find("skip").addEventListener("click", () => this.end());
    document.addEventListener("keydown", ({ key, defaultPrevented }) => {
      if (key === "Escape" && !defaultPrevented) this.end();
    });
  }

  /** The question is asked: to who sees the page for the first time with the opening. @param {boolean} isFirst */
  begin(isFirst) {
    this.isOn = isFirst && read(KEPT) === null;
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!this.isOn || isStill) this.show([WAY], true);
    if (!this.isOn) return;
    keep(KEPT, "seen");
    document.body.dataset.opening = isStill ? "still" : "first";
    this.show(SHOWN, true);
    this.limit(SPEED);
  }

  /** @param {number} time s of the run */
  follow(time) {
    if (time > LENGTH) this.end();
  }

  /** The arrows have been seen; the way of the push stays until the answer, and so does the sentence. */
  end() {
    if (!this.isOn) return;
    this.isOn = false;
    document.body.dataset.opening = "read";
    this.show(SHOWN, false);
    this.limit(Infinity);
    this.show([WAY], true);
  }

  /** The question is no longer asked. */
  leave() {
    this.end();
    delete document.body.dataset.opening;
    this.show([WAY], false);
  }
}
