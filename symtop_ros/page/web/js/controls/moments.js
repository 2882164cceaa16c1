// Moments of the motion that a user keeps by a name, in this browser: each is a start, with its doubles.

import { keep, read } from "./choices.js";
import { find, make } from "./document.js";
import { splitLink, writeLink } from "../run/links.js";
import { writeNumber } from "../words/numbers.js";
import { NANO } from "../physics/course.js";
import { phrase } from "../words/wording.js";

/** @import { Sample } from "../run/telling.js" */
/** @typedef {{name: string, link: string}} Moment */

const STORE = "moments";

/** Those of a browser; another version may have kept something else. @returns {Moment[]} */
const readMoments = () => {
  try {
    const kept = JSON.parse(read(STORE) ?? "[]");
    const isMoment = (/** @type {any} */ each) =>
      typeof each?.name === "string" && typeof each?.link === "string";
    return Array.isArray(kept) ? kept.filter(isMoment) : [];
  } catch {
    return [];
  }
};

export class Moments {
  /** @param {(message: import("../run/acts.js").Message) => void} send */
  constructor(send) {
    this.send = send;
    /** What is shown now. @type {Sample | null} */
    this.sample = null;
    this.name = find("moment-name", HTMLInputElement);
    find("keep-moment").addEventListener("click", () => this.keep());
    this.name.addEventListener("keydown", ({ key }) => {
      if (key === "Enter") this.keep();
    });
    this.show(readMoments());
  }

  /** @param {Sample} sample of now */
  follow(sample) {
    this.sample = sample;
  }

  /** Keep the state of now; one without a name has that of its time. */
  keep() {
    if (!this.sample) return;
    const { course, state, time } = this.sample;
    const name = this.name.value.trim() || `${writeNumber(time / NANO, "2f")} s`;
    this.name.value = "";
    this.store([...readMoments(), { name, link: writeLink({ ...course, start: state }) }]);
  }

  /** @param {Moment[]} moments */
  store(moments) {
    keep(STORE, JSON.stringify(moments));
    this.show(moments);
  }

  /** @param {Moment[]} moments */
  show(moments) {
    find("moments").replaceChildren(
      ...moments.map(({ name, link }, k) => {
        const start = make("button", { textContent: name });
        start.addEventListener("click", () => this.send({ act: "link", link: splitLink(link) }));
        const label = phrase("page.forget_moment", { name });
        const remove = make("button", {
          textContent: "\u00d7",
          className: "remove",
          "aria-label": label,
        });
        remove.addEventListener("click", () =>
          this.store(moments.filter((_, other) => other !== k)),
        );
        return make("div", { className: "row" }, start, remove);
      }),
    );
  }
}
