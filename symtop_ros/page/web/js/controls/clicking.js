// Clicks in a film: the pivot, a length, and the ball in frame after frame; with a suggestion of the ball
// that is taken or not.

import { findBall, findLook, joinLooks, predict } from "../film/ball.js";
import { addClick, History, listMarks, setBall } from "../film/clicks.js";
import { writeClicking } from "./click_texts.js";
import { find, findAll } from "./document.js";
import { refuse, refuseField, acceptField } from "./notices.js";
import { Stage } from "./stage.js";
import { halveLastDigit, parseQuantity } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Answer, Look } from "../film/ball.js" */
/** @import { Aim, Clicks, Place } from "../film/clicks.js" */
/** @import { Film } from "../film/film.js" */
/** @import { Lengths, Typed } from "../film/measured.js" */

const [FEWEST, MOST, USUAL] = [20, 200, 60]; // frames that are clicked
const RECENT = 8; // looks of the ball, of the frames that were clicked last
/** @type {{[key: string]: Place}} px of the film, to the right and down */
const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** A number that was typed into a field, and how well it is known; null if it is none. @param {string} id @returns {Typed | null} */
const readLength = (id) => {
  const { value: text } = find(id, HTMLInputElement);
  const value = parseQuantity(text, {});
  const half = halveLastDigit(text);
  return value > 0 ? { value, half: half === null ? 0 : parseQuantity(half, {}) } : null;
};

export class Clicking {
  /** @param {() => void} tell that something has changed */
  constructor(tell) {
    this.tell = tell;
    this.history = new History();
    this.stage = new Stage((place, taken) => this.click(place, taken));
    /** @type {Film | null} */
    this.film = null;
    /** @type {Aim} */
    this.aim = "pivot";
    /** Looks of the ball in frames that were clicked. @type {Map<number, Look>} */
    this.looks = new Map();
    /** Where the ball seems to be in this frame. @type {Answer | null} */
    this.answer = null;
    /** The frames between which the ball is clicked. */
    this.stretch = { begin: 0, end: 0 };
    this.isFollowing = false; // the ball, without asking
    /** The path of the motion that was fitted, and where it is now. @type {{path: Place[], now: Place | null}} */
    this.motion = { path: [], now: null };
    this.listen();
  }

  listen() {
    for (const button of findAll("[data-aim]"))
      button.addEventListener("click", () => this.choose(/** @type {Aim} */ (button.dataset.aim)));
    /** @type {{[id: string]: () => void}} */
    const acts = {
      "frame-back": () => this.go(-1),
      "frame-next": () => this.go(1),
      "begin-here": () => this.cut("begin"),
      "end-here": () => this.cut("end"),
      "take-ball": () => this.accept(),
      "follow-ball": () => this.follow(),
      "undo-click": () => this.undo(),
      "remove-click": () => this.remove(),
    };
    for (const [id, act] of Object.entries(acts)) find(id).addEventListener("click", act);
    for (const id of ["wanted-frames", "length-value", "ball-value"])
      find(id).addEventListener("input", () => this.show());
    document.addEventListener("keydown", (event) => this.press(event));
  }

  /** @param {Film | null} film @param {boolean} isSame as before, so that its clicks stay */
  take(film, isSame = false) {
    this.film = film;
    if (!isSame) {
      this.history.clear();
      this.looks.clear();
      this.aim = "pivot";
      this.stretch = { begin: 0, end: film ? film.times.length - 1 : 0 };
    }
    this.motion = { path: [], now: null };
    this.stage.take(film);
    this.look();
  }

  /** The times of the frames have changed. */
  retime() {
    const last = (this.film?.times.length ?? 1) - 1;
    const { begin, end } = this.stretch;
    this.stretch = { begin: Math.min(begin, last), end: end && end < last ? end : last };
    this.show();
  }

  /** Times are known, so that there are frames. */
  get isReady() {
    return this.film?.begins != null;
  }

  get clicks() {
    return this.history.now;
  }

  /** The lengths that were typed, if both were. @returns {Lengths | null} */
  get lengths() {
    const [length, ball] = ["length-value", "ball-value"].map(readLength);
    return length && ball && this.clicks.length.length === 2 ? { length, ball } : null;
  }

  /** @param {Aim} aim */
  choose(aim) {
    this.aim = aim;
    this.look();
  }

  /** @param {Place} place @param {number | null} taken mark that is moved */
  click(place, taken) {
    const { film } = this;
    if (!film || (this.aim === "ball" && !this.isReady)) return;
    if (place[0] < 0 || place[1] < 0 || place[0] > film.width || place[1] > film.height) {
      refuse(phrase("measure.outside"));
      return;
    }
    refuse("");
    const marks = listMarks(this.clicks, film.place);
    if (taken !== null && marks[taken]) this.commit(marks[taken].move(place), marks[taken].aim);
    else this.add(place);
  }

  /** @param {Place} place */
  add(place) {
    const { film, aim } = this;
    if (!film) return;
    this.commit(addClick(this.clicks, aim, film.place, place), aim);
    if (aim === "pivot") this.choose("ball");
    else if (aim === "length" && this.clicks.length.length === 2) this.choose("ball");
    else if (aim === "ball") this.go(1);
  }

  /** @param {Clicks} clicks @param {Aim} aim that has changed */
  commit(clicks, aim) {
    this.history.take(clicks);
    if (aim === "ball") this.learn();
    this.look();
    this.tell();
  }

  /** Keep what the ball looks like in this frame. */
  learn() {
    const { film } = this;
    if (!film) return;
    const place = this.clicks.balls.get(film.place);
    const look = place ? findLook(film.picture, place) : null;
    this.looks.delete(film.place);
    if (look) this.looks.set(film.place, look);
  }

  undo() {
    this.isFollowing = false;
    this.history.undo();
    for (const frame of [...this.looks.keys()])
      if (!this.clicks.balls.has(frame)) this.looks.delete(frame);
    this.look();
    this.tell();
  }

  /** Take the ball of this frame away. */
  remove() {
    const { film } = this;
    if (film && this.clicks.balls.has(film.place))
      this.commit(setBall(this.clicks, film.place, null), "ball");
  }

  /** The number of frames that are wanted; a text that is none is refused. */
  get wanted() {
    const input = find("wanted-frames", HTMLInputElement);
    const text = input.value.trim() || String(USUAL);
    const value = parseQuantity(text, {});
    const isGood = Number.isInteger(value) && value >= FEWEST && value <= MOST;
    if (isGood) acceptField(input);
    else
      refuseField(
        input,
        phrase("measure.wanted_refused", { least: FEWEST, most: MOST, got: text }),
      );
    return isGood ? value : USUAL;
  }

  /** The step from one frame that is clicked to the next. */
  get step() {
    const { begin, end } = this.stretch;
    return Math.max(1, Math.round((end - begin) / (this.wanted - 1)));
  }

  /** Frames that are to be clicked. */
  get planned() {
    const { begin, end } = this.stretch;
    const { step } = this;
    return Array.from({ length: Math.floor((end - begin) / step) + 1 }, (_, k) => begin + k * step);
  }

  /** @param {"begin" | "end"} which of the stretch is this frame */
  cut(which) {
    const { film } = this;
    if (!film) return;
    const stretch = { ...this.stretch, [which]: film.place };
    if (stretch.begin < stretch.end) this.stretch = stretch;
    else refuse(phrase("measure.stretch"));
    this.show();
  }

  /** Go to the next frame that is to be clicked, or to the one before. @param {1 | -1} way */
  async go(way) {
    const { film, planned } = this;
    if (!film) return;
    const { place } = film;
    const next =
      way > 0 ? planned.find((each) => each > place) : planned.findLast((each) => each < place);
    if (next !== undefined) await this.visit(next);
  }

  /** @param {number} frame */
  async visit(frame) {
    const { film } = this;
    if (!film) return;
    try {
      await film.show(frame);
    } catch (error) {
      this.isFollowing = false;
      refuse(error instanceof Error ? error.message : String(error));
    }
    this.look();
  }

  /** Look for the ball in the frame that is shown. */
  look() {
    const { film, looks } = this;
    this.answer = null;
    if (film && this.aim === "ball" && looks.size && !this.clicks.balls.has(film.place)) {
      const expected = predict(this.clicks.balls, film.times, film.place);
      const look = joinLooks([...looks.values()].slice(-RECENT));
      if (expected) {
        this.answer = findBall(film.picture, look, expected);
        this.stage.keepInSight(expected.place);
      }
    }
    this.show();
  }

  /** Take the suggestion. */
  accept() {
    if (this.answer?.kind === "found") this.add(this.answer.place);
  }

  /** Take suggestions until the ball is in doubt, or until it is ended. */
  async follow() {
    this.isFollowing = !this.isFollowing;
    while (this.isFollowing && this.film && this.answer?.kind === "found") {
      const { place } = this.film;
      this.commit(setBall(this.clicks, place, this.answer.place), "ball");
      await this.go(1);
      if (this.film?.place === place) break; // the last one
    }
    this.isFollowing = false;
    this.show();
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const { key } = event;
    const isTyped = event.target instanceof HTMLInputElement && event.target.type === "text";
    if (isTyped || find("measure").hidden) return;
    const isUndo = (event.ctrlKey || event.metaKey) && key.toLowerCase() === "z";
    const step = event.target === this.stage.canvas ? STEPS[key] : undefined;
    if (isUndo) this.undo();
    else if (event.target !== this.stage.canvas) return;
    else if (step) this.nudge(step);
    else if (key === "Enter") this.accept();
    else if (key === "Delete" || key === "Backspace") this.remove();
    else if (key === "PageDown") this.go(1);
    else if (key === "PageUp") this.go(-1);
    else return;
    event.preventDefault();
  }

  /** Move the click of this frame by a pixel; without one it begins where it is expected. @param {Place} step */
  nudge([right, down]) {
    const { film } = this;
    if (!film || (this.aim === "ball" && !this.isReady)) return;
    const mark = listMarks(this.clicks, film.place).findLast(({ aim }) => aim === this.aim);
    const expected =
      this.aim === "ball" ? predict(this.clicks.balls, film.times, film.place) : null;
    const from = mark?.place ?? expected?.place ?? this.stage.middle;
    const clip = (/** @type {number} */ value, /** @type {number} */ most) =>
      Math.min(Math.max(value, 0), most);
    /** @type {Place} */
    const to = [clip(from[0] + right, film.width), clip(from[1] + down, film.height)];
    this.commit(mark ? mark.move(to) : addClick(this.clicks, this.aim, film.place, to), this.aim);
  }

  /** Show marks and texts of what holds now. */
  show() {
    const { film, clicks, answer, aim, motion } = this;
    const own = film ? listMarks(clicks, film.place) : [];
    const others = [...clicks.balls]
      .filter(([frame]) => frame !== film?.place)
      .map(([, place]) => ({ place, aim: /** @type {const} */ ("other") }));
    const found =
      answer?.kind === "found"
        ? [{ place: answer.place, aim: /** @type {const} */ ("suggestion") }]
        : [];
    const now = motion.now ? [{ place: motion.now, aim: /** @type {const} */ ("motion") }] : [];
    this.stage.overlay = { marks: [...own, ...others, ...found, ...now], path: motion.path };
    this.stage.movable = own.length;
    this.stage.draw();
    for (const button of findAll("[data-aim]"))
      button.setAttribute("aria-pressed", String(button.dataset.aim === aim));
    if (film) writeClicking(this, film);
  }
}
