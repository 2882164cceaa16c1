// A film from a file: its frames one by one, each with the time at which the camera took it.

import { readMp4Times } from "./mp4.js";
import { readWebmTimes } from "./webm.js";
import { phrase } from "../words/wording.js";

/** @import { Sort } from "./sorts.js" */

const PATIENCE = 30_000; // ms until a browser that says nothing of a file is taken to have no codec
const DRAWN = 250; // ms; a frame that is the same is not presented again
const ASKED = 1e-4; // s
const TRIES = 3; // searches more for a frame
const STEADY = 0.1; // of a step, by which the times of a steady film differ from even ones
const FAR = 1e7; // s, beyond the end of any film
const FEWEST = 2; // frames

/** @param {string} kind @param {File} file */
const refuse = (kind, { name }) => new RangeError(phrase("measure.refused", { kind, name }));

/** @param {File} file @param {Sort} sort @returns {Promise<number[] | null>} */
const readTimes = async (file, sort) => {
  if (sort === "mp4") return await readMp4Times(file);
  return sort === "webm" ? await readWebmTimes(file) : null;
};

/** @param {EventTarget} target @param {string[]} names @returns {Promise<string>} the first event */
const wait = (target, names) =>
  new Promise((done) => {
    const timer = setTimeout(() => done("late"), PATIENCE);
    const end = (/** @type {Event} */ { type }) => {
      clearTimeout(timer);
      for (const name of names) target.removeEventListener(name, end);
      done(type);
    };
    for (const name of names) target.addEventListener(name, end);
  });

/** The middle one of the steps. @param {number[]} times */
const findStep = (times) => {
  const steps = times.slice(1).map((each, k) => each - times[k]);
  return steps.sort((a, b) => a - b)[steps.length >> 1];
};

/** The place of the nearest of some times, which grow. @param {number[]} times @param {number} time */
const findNearest = (times, time) => {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] > time) high = middle;
    else low = middle;
  }
  return time - times[low] <= times[high] - time ? low : high;
};

export class Film {
  /** @param {File} file @param {HTMLVideoElement} video @param {number[] | null} begins of the frames, in s */
  constructor(file, video, begins) {
    this.file = file;
    this.video = video;
    this.width = video.videoWidth; // as a phone has turned it
    this.height = video.videoHeight;
    /** The browser's times, each when a frame begins; null until the rate is known. */
    this.begins = begins;
    this.isReal = begins !== null;
    /** Times of the frames in s, as the camera took them. @type {number[]} */
    this.times = begins ?? [0];
    this.place = 0; // of the frame that is in the picture
    this.wanted = 0;
    /** When the frame that was shown last begins, if the browser knows. @type {number | null} */
    this.seen = null;
    /** @type {Promise<void> | null} */
    this.work = null;
    this.canvas = document.createElement("canvas");
    Object.assign(this.canvas, { width: this.width, height: this.height });
    this.picture = /** @type {CanvasRenderingContext2D} */ (
      this.canvas.getContext("2d", { willReadFrequently: true })
    );
  }

  /** A RangeError says why a file is no film. @param {File} file @param {Sort} sort */
  static async open(file, sort) {
    const begins = await readTimes(file, sort);
    if (begins && begins.length < FEWEST) throw refuse(begins.length ? "frame" : "sound", file);
    const video = document.createElement("video");
    Object.assign(video, { muted: true, playsInline: true, preload: "auto" });
    video.src = URL.createObjectURL(file);
    const ready = await wait(video, ["loadeddata", "error"]);
    if (ready === "loadeddata" && video.videoWidth) {
      const film = new Film(file, video, begins);
      if (!Number.isFinite(video.duration)) await film.seek(FAR); // then the browser knows its end
      await film.show(0);
      film.align();
      return film;
    }
    URL.revokeObjectURL(video.src);
    const isSound = ready === "loadeddata" && !begins;
    throw refuse(isSound ? "sound" : "codec", file);
  }

  /** The browser may count from the first frame where the file does not. */
  align() {
    if (this.seen === null || !this.begins) return;
    const late = this.seen - this.begins[0];
    this.times = this.begins = this.begins.map((each) => each + late);
  }

  close() {
    URL.revokeObjectURL(this.video.src);
    this.video.removeAttribute("src");
    this.video.load();
  }

  /** Frames in a second, between the first and the last one. */
  get rate() {
    const { times } = this;
    const last = times.length - 1;
    return last ? last / (times[last] - times[0]) : null;
  }

  /** The least and the largest rate of a film whose frames are not even; null if they are. */
  get rates() {
    const steps = this.times.slice(1).map((each, k) => each - this.times[k]);
    const [least, most] = [Math.min(...steps), Math.max(...steps)];
    const isSteady = most - least <= STEADY * findStep(this.times) + 0.0011; // WebM has whole ms
    return isSteady ? null : { least: 1 / most, most: 1 / least };
  }

  /**
   * Frames were taken at this rate: of a film whose times cannot be read, or in slow motion.
   * @param {number | null} rate in 1/s; null for the times of the file
   */
  setRate(rate) {
    const { duration } = this.video;
    if (!this.isReal)
      this.begins = rate
        ? Array.from({ length: Math.round(duration * rate) }, (_, k) => k / rate)
        : null;
    const begins = this.begins ?? [0];
    this.times = rate ? begins.map((_, k) => k / rate) : begins;
  }

  /** The frame nearest to a time in s. @param {number} time */
  find(time) {
    return findNearest(this.times, time);
  }

  /** Show a frame; of several that are asked for at once the last one. @param {number} place */
  show(place) {
    this.wanted = Math.min(Math.max(place, 0), this.times.length - 1);
    this.work ??= this.draw().finally(() => {
      this.work = null;
    });
    return this.work;
  }

  async draw() {
    let [place, again] = [-1, 0];
    // What is presented may still be the frame of the search before: then the same is searched again.
    while (place !== this.wanted || (this.place !== place && again < TRIES)) {
      again = place === this.wanted ? again + 1 : 0;
      place = this.wanted;
      await this.seek(this.findMiddle(place));
      this.picture.drawImage(this.video, 0, 0, this.width, this.height);
      this.place = this.confirm(place);
    }
  }

  /** The frame that is shown, if the browser says when it begins. @param {number} place that was asked for */
  confirm(place) {
    const { seen, begins } = this;
    if (seen === null || !begins) return place;
    if (this.isReal) return findNearest(begins, seen);
    this.times[place] = seen;
    return place;
  }

  /** A time of the browser at which a frame is shown, as far from others as can be. @param {number} place */
  findMiddle(place) {
    const begins = this.begins ?? [0, 0];
    const begin = begins[place];
    const end = begins[place + 1] ?? begin + findStep(begins);
    return (begin + end) / 2;
  }

  /** @param {number} time s @returns {Promise<void>} */
  async seek(time) {
    const { video } = this;
    if (video.error) throw refuse("lost", this.file);
    const presented = this.listen();
    const ended = wait(video, ["seeked", "error"]);
    video.currentTime = time;
    if ((await ended) !== "seeked") throw refuse("lost", this.file);
    const late = new Promise((done) => setTimeout(done, DRAWN));
    const began = await Promise.race([presented, late]);
    // Firefox and WebKit say the time that was asked for.
    this.seen = typeof began === "number" && Math.abs(began - time) > ASKED ? began : null;
  }

  /**
   * The time of the next frame that is presented; a browser without that has it when the search has ended.
   * @returns {Promise<number | null>}
   */
  listen() {
    const { video } = this;
    if (!("requestVideoFrameCallback" in video)) return Promise.resolve(null);
    return new Promise((done) =>
      video.requestVideoFrameCallback((_, { mediaTime }) => done(mediaTime)),
    );
  }
}
