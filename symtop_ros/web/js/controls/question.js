// The first question: what a push along the way will do. Its answer is compared with what happens.

import { keep, read } from "./choices.js";
import { find, findAll, say } from "./document.js";
import { phrase } from "../words/wording.js";

/** @import { Facts } from "../words/facts.js" */

const KEPT = "answer"; // as the browser keeps it: who comes again is not asked

/** What was answered, by this visitor or an earlier one of the browser. @returns {string | null} */
export const readAnswer = () => read(KEPT);

export class Question {
  /** @param {() => void} push */
  constructor(push) {
    /** The answer of now. @type {string | null} */
    this.answer = null;
    this.end = Infinity; // s of the run at which the answer is seen
    /** Times of the acts, which tell a new act. @type {string | null} */
    this.acts = null;
    for (const button of findAll("[data-answer]")) {
      button.addEventListener("click", () => {
        this.answer = button.dataset.answer ?? "";
        keep(KEPT, this.answer);
        push();
      });
    }
  }

  /** Ask, unless this browser has answered. */
  ask() {
    if (readAnswer() === null) this.enter("ask");
  }

  /** @param {"ask" | "watch" | ""} stage */
  enter(stage) {
    if (stage) document.body.dataset.asked = stage;
    else delete document.body.dataset.asked;
  }

  /** The push leads to what is seen, and another act ends the question. @param {Facts} facts @param {string} happened */
  follow({ acts, half }, happened) {
    say("happened", happened);
    const isNew = this.acts !== null && this.acts !== String(acts);
    this.acts = String(acts);
    if (!isNew) return;
    if (this.answer === null || half === null || this.end < Infinity) this.leave();
    else {
      this.end = half;
      say("predicted", phrase("predicted", { kind: this.answer }));
      this.enter("watch");
    }
  }

  leave() {
    this.answer = null;
    this.end = Infinity;
    this.enter("");
    find("compared").hidden = true;
  }

  /** What happened stands beside the answer once it has been seen. @param {number} time s */
  show(time) {
    if (this.answer === null || time < this.end) return;
    this.enter("");
    find("compared").hidden = false;
  }
}
