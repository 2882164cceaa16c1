// The first question: what a push along the way will do. Its answer is compared with what happens. Then
// the same is asked at the fast precession, where the same push does the opposite.

import { keep, read } from "./choices.js";
import { find, findAll, say } from "./document.js";
import { recall, remember } from "../run/memory.js";
import { writeNumber } from "../words/numbers.js";
import { phrase } from "../words/wording.js";

/** @import { Facts } from "../words/facts.js" */

const KEPT = "answer"; // as the browser keeps it: who comes again is not asked
/** The change that an answer foretells, and the one against it. @type {{[answer: string]: string[]}} */
const MEANT = { rises: ["higher", "lower"], falls: ["lower", "higher"] };
const FAST = "fast_precession"; // the scene of the second question

/** What was answered, by this visitor or an earlier one of the browser. @returns {string | null} */
export const readAnswer = () => read(KEPT);

/** A button that a key has pressed disappears: what is said is next. @param {MouseEvent} event */
const keepFocus = ({ detail }) => {
  if (!detail) find("strip").focus();
};

export class Question {
  /**
   * @param {() => void} push @param {(scene: string) => void} start
   * @param {import("./opening.js").Opening} opening
   */
  constructor(push, start, opening) {
    this.opening = opening;
    /** The answer of now. @type {string | null} */
    this.answer = null;
    this.end = Infinity; // s of the run at which the answer is seen
    /** Times of the acts, which tell a new act. @type {string | null} */
    this.acts = null;
    this.isStarting = false; // the motion of the second question
    this.isSecond = false;
    /** Regular rates of the motions that were pushed, the first one and the second. @type {number[][]} */
    this.roots = [];
    for (const button of findAll("[data-answer]")) {
      button.addEventListener("click", (event) => {
        keepFocus(event);
        this.answer = button.dataset.answer ?? "";
        if (!this.isSecond) keep(KEPT, this.answer);
        push();
      });
    }
    find("second").addEventListener("click", (event) => {
      keepFocus(event);
      this.leave();
      this.isStarting = this.isSecond = true;
      start(FAST);
    });
  }

  /** Ask, unless this browser has answered. */
  ask() {
    if (readAnswer() === null) this.enter("ask");
  }

  /** @param {"ask" | "watch" | ""} stage */
  enter(stage) {
    const { dataset } = document.body;
    if (stage === "ask") this.opening.begin(!this.isSecond);
    else if (dataset.asked === "ask") this.opening.leave();
    if (stage) dataset.asked = stage;
    else delete dataset.asked;
  }

  /** The push leads to what is seen, and another act ends the question. @param {Facts} facts */
  follow({ acts, half, push_roots: roots, seen, since }) {
    const is = `${since}: ${acts}`; // a start may be at the same time as the one before
    const isNew = this.acts !== null && this.acts !== is;
    this.acts = is;
    if (this.isStarting) {
      this.isStarting = false;
      this.roots.push(roots);
      this.enter("ask");
      return;
    }
    if (!isNew) return;
    if (this.answer === null || half === null || this.end < Infinity) this.leave();
    else {
      if (!this.isSecond) this.roots = [roots];
      this.watch(this.answer, half, seen);
    }
  }

  /**
   * Have the visitor watch what follows the answer; a reload of the page loses neither.
   * @param {string} answer @param {number} end s of the run @param {string[] | null} seen
   */
  watch(answer, end, seen) {
    this.end = end;
    const [meant, opposite] = MEANT[answer];
    const isRight = seen?.includes(meant) && !seen.includes(opposite);
    const kind = isRight ? "right" : "other";
    say("compared", phrase("guess", { kind, answer, seen }));
    this.enter("watch");
    const { isSecond, roots } = this;
    remember({ question: { answer, isSecond, roots } });
  }

  /** Continue after a reload of the page. @param {Facts} facts */
  resume({ half, seen }) {
    const { question } = recall();
    if (!question || half === null) return;
    Object.assign(this, question);
    this.watch(question.answer, half, seen);
  }

  leave() {
    this.answer = null;
    this.end = Infinity;
    this.enter("");
    this.isSecond = false;
    if (recall().question) remember({ question: null });
    for (const name of ["compared", "second", "between"]) find(name).hidden = true;
  }

  /** What happened stands beside the answer once it has been seen. @param {number} time s */
  show(time) {
    this.opening.follow(time);
    if (this.answer === null || time < this.end) return;
    this.enter("");
    find("compared").hidden = false;
    find(this.isSecond ? "between" : "second").hidden = false;
    if (!this.isSecond) return;
    const [slow, fast, low, high] = this.roots.flat().map((each) => writeNumber(each, "2r"));
    say("between", phrase("page.between", { slow, fast, low, high }));
  }
}
