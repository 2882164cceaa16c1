// The slider over the time of the run, with the time beside it and a mark at each act.

import { find, make, moveByKeys, whenReleased, write } from "./document.js";
import { phrase } from "../words/wording.js";
import { writeNumber } from "../words/numbers.js";

export class Timeline {
  /** @param {(time: number) => void} seek */
  constructor(seek) {
    this.line = find("timeline", HTMLInputElement);
    this.isDragged = false;
    /** Times of the acts in s. @type {number[]} */
    this.acts = [];
    this.since = 0; // s of the run at which the motion was started; older acts are shown when asked for
    this.hasOlder = false;
    this.older = find("older");
    this.older.addEventListener("click", () => {
      this.hasOlder = !this.hasOlder;
    });
    this.line.addEventListener("input", () => {
      this.isDragged = true;
      seek(Number(this.line.value));
    });
    whenReleased(this.line, () => {
      this.isDragged = false;
    });
    moveByKeys(this.line);
  }

  /** @param {number} time s of the run @param {number} end s */
  show(time, end) {
    if (!this.isDragged) Object.assign(this.line, { max: end, value: time });
    this.line.style.setProperty("--part", `${end ? (100 * time) / end : 0}%`);
    this.line.setAttribute("aria-valuetext", phrase("time", { time, end }));
    find("clock").textContent = `${writeNumber(time, "2f")} s`;
    this.mark(end);
  }

  /** @param {number} end s */
  mark(end) {
    const { acts, since, older, hasOlder } = this;
    const first = hasOlder ? 0 : since;
    const shown = acts
      .filter((time) => time >= first && time <= end)
      .map((time) => (end ? time / end : 0));
    const count = acts.filter((time) => time < since).length;
    older.hidden = !count;
    older.setAttribute("aria-pressed", String(hasOlder));
    write(older, `+${count}`);
    const marks = shown.map((place) => make("i", { style: `left: ${(100 * place).toFixed(2)}%` }));
    find("marks").replaceChildren(...marks);
  }
}
