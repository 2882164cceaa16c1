// Measure a top: a film or a table of points, its fit, and the motion that was found beside the film.

import { Clicking } from "./clicking.js";
import { Film } from "../film/film.js";
import { makeGiven, writeCommand, writeTable } from "../film/measured.js";
import { isSame, see, tracePath } from "../film/motion.js";
import { findSort } from "../film/sorts.js";
import { readTable } from "../film/table.js";
import { find, say } from "./document.js";
import { hideFitted, showFitted } from "./fitted.js";
import { acceptField, refuse, refuseField } from "./notices.js";
import { openTab } from "./tabs.js";
import { save } from "../run/files.js";
import { NANO } from "../physics/course.js";
import { parseQuantity } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { Fitting } from "../fit/client.js" */
/** @import { Table } from "../film/table.js" */
/** @import { Given } from "../film/measured.js" */
/** @import { Points } from "../run/marks.js" */
/** @import { LocalTop } from "../run/local.js" */
/** @import { Message } from "../run/acts.js" */

const NAME = "measured.csv";
const [SLOWEST, FASTEST] = [1, 10_000]; // frames in a second

export class Measure {
  /**
   * @param {(message: Message) => void} send
   * @param {(run: any) => void} load opens a run
   */
  constructor(send, load) {
    this.send = send;
    this.load = load;
    this.clicking = new Clicking(() => this.show());
    /** @type {Film | null} */
    this.film = null;
    /** @type {{name: string, table: Table} | null} */
    this.table = null;
    /** A film or a table that waits for an answer: the clicks would be lost. @type {(() => Promise<void>) | null} */
    this.waiting = null;
    /** The film that is being opened, or was last. @type {File | null} */
    this.opening = null;
    /** @type {Fitting | null} */
    this.fitting = null; // while the kernel is loaded
    this.isFitting = false;
    /** The points of the run that was fitted, and the time of the film at which it begins. @type {{points: Points, begin: number} | null} */
    this.linked = null;
    this.isShown = false; // the motion of now is the one that was fitted
    this.listen();
    this.show();
  }

  /** Fit from now on. @param {Fitting} fitting */
  connect(fitting) {
    this.fitting = fitting;
    this.show();
  }

  listen() {
    const input = find("measured-file", HTMLInputElement);
    input.addEventListener("change", () => {
      const file = input.files?.[0];
      if (file) this.open(file);
      input.value = ""; // the same file can be chosen again
    });
    /** @type {{[id: string]: () => void}} */
    const acts = {
      "replace-film": () => this.answer(true),
      "keep-film": () => this.answer(false),
      "fit-record": () => this.fit(),
      "stop-fit": () => this.stop(),
      "save-measured": () => this.save(),
      "close-film": () => this.setPlace(""),
      "open-film": () => this.setPlace(this.isShown ? "beside" : "whole"),
    };
    for (const [id, act] of Object.entries(acts)) find(id).addEventListener("click", act);
    find("film-rate").addEventListener("change", () => this.setRate());
    for (const id of ["near-camera", "length-value", "ball-value"])
      find(id).addEventListener("input", () => this.show());
    find("film-line").addEventListener("input", () => this.seek());
  }

  /** Open a film or a table; another file is refused in a line. @param {File} file */
  async open(file) {
    refuse("");
    openTab("measure");
    try {
      const sort = await findSort(file);
      if (sort === "table") await this.offerTable(file);
      else if (["webm", "mp4", "film"].includes(sort)) await this.offerFilm(file, sort);
      else throw new RangeError(phrase("measure.refused", { kind: sort, name: file.name }));
    } catch (error) {
      this.refuse(error, file.name);
    }
  }

  /** @param {unknown} error @param {string} name */
  refuse(error, name) {
    // A file that cannot be read has a DOMException.
    const isOurs = error instanceof RangeError;
    refuse(isOurs ? error.message : phrase("measure.refused", { kind: "lost", name }));
    if (!isOurs) console.warn(error);
  }

  /** @param {File} file */
  async offerTable(file) {
    const table = await readTable(file);
    this.ask(file.name, async () => {
      this.stop(); // its result would be shown with this table
      this.film?.close();
      this.film = null;
      this.clicking.take(null);
      this.setPlace("");
      this.table = { name: file.name, table };
      this.linked = null;
      hideFitted();
      this.show();
    });
  }

  /** @param {File} file @param {import("../film/sorts.js").Sort} sort */
  async offerFilm(file, sort) {
    say("measured-name", phrase("measure.opening", { name: file.name }));
    this.opening = file;
    const film = await Film.open(file, sort).finally(() => this.show());
    if (this.opening !== file) {
      film.close(); // another one was opened meanwhile
      return;
    }
    const { film: old } = this;
    const isSame =
      old !== null &&
      old.file.name === file.name &&
      old.file.size === file.size &&
      old.width === film.width;
    const take = async () => {
      if (!isSame) this.stop(); // its result would be shown with this film
      old?.close();
      this.film = film;
      this.table = null;
      if (!isSame) {
        this.linked = null;
        hideFitted();
      }
      this.clicking.take(film, isSame); // first: the frames of its clicks may not be in this film
      this.setRateOf(film, isSame);
      this.setPlace("whole");
      this.show();
    };
    if (isSame) await take();
    else this.ask(file.name, take, () => film.close());
  }

  /**
   * Take another measurement; with clicks in the one of now its user is asked before.
   * @param {string} name @param {() => Promise<void>} take @param {() => void} [leave]
   */
  ask(name, take, leave = () => {}) {
    this.leave?.();
    this.waiting = take;
    this.leave = leave;
    if (this.clicking.history.isEmpty) this.answer(true);
    else {
      say("replace-text", phrase("measure.replace_asks", { name }));
      find("replace").hidden = false;
      find("keep-film").focus();
    }
  }

  /** @type {(() => void) | null} */
  leave = null;

  /** @param {boolean} isTaken */
  answer(isTaken) {
    const { waiting, leave } = this;
    this.waiting = this.leave = null;
    find("replace").hidden = true;
    if (isTaken) waiting?.();
    else leave?.();
  }

  /** @param {Film} film @param {boolean} isSame */
  setRateOf(film, isSame) {
    const input = find("film-rate", HTMLInputElement);
    if (!isSame) input.value = "";
    this.setRate();
    if (!film.isReal && !input.value) input.focus();
  }

  setRate() {
    const { film } = this;
    if (!film) return;
    const input = find("film-rate", HTMLInputElement);
    const text = input.value.trim();
    const rate = text ? parseQuantity(text, {}) : null;
    if (rate !== null && !(rate >= SLOWEST && rate <= FASTEST)) {
      refuseField(
        input,
        phrase("measure.rate_refused", { least: SLOWEST, most: FASTEST, got: text }),
      );
      return;
    }
    acceptField(input);
    film.setRate(rate);
    this.clicking.retime();
    this.show();
  }

  /** The record of now; null if there is none. @returns {Given | null} */
  get given() {
    const { film, table } = this;
    if (table)
      return {
        kind: table.table.kind,
        times: table.table.times,
        values: table.table.values,
        perspective: table.table.kind === "pixels" && this.isNear,
      };
    if (!film || !this.clicking.clicks.balls.size) return null;
    const { clicks, lengths } = this.clicking;
    return makeGiven(clicks, film, lengths, this.isNear);
  }

  get isNear() {
    return find("near-camera", HTMLInputElement).checked;
  }

  /** The command that fits the same record. */
  get command() {
    const { given } = this;
    return given ? writeCommand(this.table?.name ?? NAME, given) : "";
  }

  save() {
    const { given } = this;
    if (given) save(NAME, "text/csv", writeTable(given));
  }

  async fit() {
    const { given, command, fitting, film } = this;
    if (!given || !fitting) return;
    refuse("");
    this.clicking.isFollowing = false;
    this.isFitting = true;
    this.report(0);
    this.show();
    try {
      const fitted = await fitting.fit(given, (part) => this.report(part));
      this.link(fitted.run, film ? given.times[0] : null);
      showFitted(fitted, command);
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      refuse(error instanceof RangeError ? text : phrase("measure.failed", { text }));
    }
    this.isFitting = false;
    this.show();
  }

  stop() {
    this.fitting?.stop();
    this.isFitting = false;
    this.show();
  }

  /** @param {number} part that is done */
  report(part) {
    find("fit-progress", HTMLProgressElement).value = part;
  }

  /** Open a run that was fitted, with the film beside it. @param {any} run @param {number | null} begin s of the film */
  link(run, begin) {
    this.load(run);
    this.linked = begin === null ? null : { points: run.points, begin };
    this.isShown = false;
    if (begin !== null) this.setPlace("beside");
  }

  /** @param {"" | "whole" | "beside"} place of the film in the page */
  setPlace(place) {
    document.body.dataset.film = place;
    find("film").hidden = !place || !this.film;
    find("open-film").hidden = Boolean(place) || !this.film;
    this.clicking.stage.draw();
  }

  /** Move the film's own slider: the run goes to the same time, if it is the run of the film. */
  seek() {
    const { film, linked } = this;
    const frame = Number(find("film-line", HTMLInputElement).value);
    if (!film) return;
    if (linked && this.isShown)
      this.send({ act: "seek", time: Math.max(film.times[frame] - linked.begin, 0) });
    this.clicking.visit(frame);
  }

  /** Show the frame of the time of the run, and the motion over it. @param {LocalTop} top */
  follow(top) {
    const { film, linked } = this;
    if (!film || !linked || find("film").hidden) return;
    const isShown = isSame(top.points, linked.points);
    if (isShown !== this.isShown) {
      this.isShown = isShown;
      this.clicking.motion = {
        path: isShown ? tracePath(top, linked.points, film) : [],
        now: null,
      };
      this.time = NaN;
    }
    if (!isShown || top.time === this.time) return;
    this.time = top.time;
    this.clicking.motion.now = see(top, linked.points, film, top.time);
    const frame = film.find(top.time / NANO + linked.begin);
    if (frame !== film.place) this.clicking.visit(frame);
    else this.clicking.show();
  }

  time = NaN; // ns of the run; of the frame that is shown

  /** Show what can be done now. */
  show() {
    const { film, table, given, isFitting } = this;
    for (const id of ["film-controls", "film-more"]) find(id).hidden = !film;
    const isFlat = Boolean(film) || table?.table.kind === "pixels";
    find("near").hidden = !isFlat;
    say("measured-name", this.describe());
    const canFit = given !== null && this.fitting !== null;
    Object.assign(find("fit-record"), { disabled: !canFit || isFitting });
    Object.assign(find("stop-fit"), { disabled: !isFitting });
    Object.assign(find("save-measured"), { disabled: given === null || table !== null });
    find("fit-progress").hidden = !isFitting;
    find("fit-command", HTMLInputElement).value = this.command;
    find("fit-parts").hidden = given === null;
  }

  /** What is measured now. */
  describe() {
    const { film, table } = this;
    if (table) {
      const { kind: what, times, empty } = table.table;
      return phrase("measure.table_read", {
        name: table.name,
        count: times.length,
        what,
        empty: empty || null,
      });
    }
    if (!film) return "";
    const { file, width, height, times, isReal, rate, rates } = film;
    const frames = { name: file.name, width, height, count: times.length, rate };
    if (!film.begins) return phrase("measure.film_read", { kind: "asked", ...frames });
    const typed = find("film-rate", HTMLInputElement).value;
    const kind = !isReal || typed ? "typed" : rates ? "varies" : "steady";
    return phrase("measure.film_read", { kind, ...frames, ...rates });
  }
}
