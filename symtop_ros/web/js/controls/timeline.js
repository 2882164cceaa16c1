// The slider over the time of the run.

import { find, whenReleased } from "./document.js";

export class Timeline {
  /** @param {(time: number) => void} seek */
  constructor(seek) {
    this.line = find("timeline", HTMLInputElement);
    this.isDragged = false;
    this.line.addEventListener("input", () => {
      this.isDragged = true;
      seek(Number(this.line.value));
    });
    whenReleased(this.line, () => {
      this.isDragged = false;
    });
  }

  /** @param {number} time s of the run @param {number} end s */
  show(time, end) {
    if (!this.isDragged) Object.assign(this.line, { max: end, value: time });
    this.line.setAttribute("aria-valuetext", `${time.toFixed(3)} s of ${end.toFixed(3)} s`);
  }
}
