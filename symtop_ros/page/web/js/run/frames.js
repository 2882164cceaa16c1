// The frames of the browser: a top advances with each, and rests when it is left alone in a pause.

/** @import { LocalTop } from "./local.js" */

const AWAKE = 1000; // ms; left alone for so long, a page in a pause is drawn rarely
const REST = 500; // ms between two of these drawings
const DONE = ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "keyup", "click"];
const CHANGED = ["input", "change", "drop", "scroll", "toggle", "resize", "hashchange", "focus"];

export class Frames {
  /** @param {LocalTop} top */
  constructor(top) {
    this.top = top;
    this.before = NaN; // ms; the stamp of the first frame may be older than the clock of now
    this.stirred = 0; // ms; when something was done last
    this.timer = 0; // of a rest
  }

  /** Advance and draw with every frame from now on. */
  begin() {
    const stir = () => this.stir();
    for (const name of [...DONE, ...CHANGED]) addEventListener(name, stir, { capture: true });
    this.ask();
  }

  ask() {
    this.timer = 0;
    requestAnimationFrame((now) => this.step(now));
  }

  /** @param {number} now ms */
  step(now) {
    // first: an error in this frame does not end the animation
    if (this.top.isRunning || now < this.stirred + AWAKE) this.ask();
    else this.timer = window.setTimeout(() => this.ask(), REST);
    const passed = Math.max(now - this.before, 0) || 0;
    this.before = now;
    this.top.advance(passed, now);
  }

  /** End a rest. */
  stir() {
    this.stirred = performance.now();
    if (!this.timer) return;
    clearTimeout(this.timer);
    this.before = NaN; // the time of a rest is none of the motion
    this.ask();
  }
}
