// The picture of a film in which points are clicked: zoom, a loupe at the pointer, and marks over it.

import { find } from "./document.js";

/** @import { Film } from "../film/film.js" */
/** @import { Aim, Place } from "../film/clicks.js" */
/** A place with what stands there. @typedef {{place: Place, aim: Aim | "suggestion" | "other" | "motion"}} Shown */
/** Marks, the ends of a length, and curves. @typedef {{marks: Shown[], path: Place[]}} Overlay */

/** Bright ones with a dark edge, as a film may have any colour. @type {{[name: string]: string}} */
const COLORS = {
  pivot: "#ffd34d",
  length: "#8ff0c0",
  ball: "#ff8d5c",
  other: "#ff8d5c",
  suggestion: "#ffffff",
  motion: "#8ab8ff",
  path: "#8ab8ff",
};
const LOUPE = 132; // css px
const LARGER = 6; // times, of the loupe in film pixels, at least
const NEAR = 12; // css px between the pointer and a mark that it takes
const ZOOM = 1.25; // of a step
const MOST = 24; // css px of a pixel of the film
const SHARP = 3; // from here on pixels are squares
const ARM = 9; // css px of the cross of the pivot
const DARK = "rgb(0 0 0 / 0.65)"; // around what is drawn, so that it is seen over any picture

export class Stage {
  /**
   * @param {(place: Place, taken: number | null) => void} click a place in the film, and which mark was moved there
   */
  constructor(click) {
    this.click = click;
    this.canvas = find("film-picture", HTMLCanvasElement);
    this.loupe = find("film-loupe", HTMLCanvasElement);
    /** @type {Film | null} */
    this.film = null;
    /** Css px of a pixel of the film, in whole pictures that fit. */
    this.zoom = 1;
    /** The pixel of the film in the middle. @type {Place} */
    this.middle = [0, 0];
    /** @type {Overlay} */
    this.overlay = { marks: [], path: [] };
    /** The marks that can be moved, first in the overlay. */
    this.movable = 0;
    this.isActive = true;
    /** @type {{place: Place, taken: number | null} | null} */
    this.held = null;
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    for (const name of /** @type {const} */ (["pointercancel", "pointerleave"]))
      canvas.addEventListener(name, () => this.leave());
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoomBy(event.deltaY < 0 ? ZOOM : 1 / ZOOM, this.locate(event));
      },
      { passive: false },
    );
    find("film-nearer").addEventListener("click", () => this.zoomBy(ZOOM));
    find("film-farther").addEventListener("click", () => this.zoomBy(1 / ZOOM));
  }

  /** @param {Film | null} film */
  take(film) {
    this.film = film;
    this.zoom = 1;
    if (film) this.middle = [film.width / 2, film.height / 2];
    this.draw();
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (!this.film || !this.isActive || event.button) return;
    if (event.isTrusted) this.canvas.setPointerCapture(event.pointerId);
    const place = this.locate(event);
    this.held = { place, taken: this.findNear(place) };
    this.showLoupe(event);
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (!this.film || !this.isActive) return;
    if (this.held) this.held.place = this.locate(event);
    this.showLoupe(event);
    if (this.held) this.draw();
  }

  /** @param {PointerEvent} event */
  release(event) {
    const { held } = this;
    this.held = null;
    if (held) this.click(this.locate(event), held.taken);
    if (event.pointerType !== "mouse") this.loupe.hidden = true;
  }

  leave() {
    this.held = null;
    this.loupe.hidden = true;
  }

  /** Css px of a pixel of the film. */
  get scale() {
    const { canvas, film } = this;
    if (!film) return 1;
    const fit = Math.min(canvas.clientWidth / film.width, canvas.clientHeight / film.height);
    return this.zoom * fit;
  }

  /** @param {MouseEvent} event @returns {Place} */
  locate({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const [x, y] = this.middle;
    return [
      x + (clientX - left - width / 2) / this.scale,
      y + (clientY - top - height / 2) / this.scale,
    ];
  }

  /** The movable mark at a place. @param {Place} place */
  findNear([x, y]) {
    const { marks } = this.overlay;
    let [nearest, found] = [NEAR / this.scale, /** @type {number | null} */ (null)];
    for (const [k, { place }] of marks.slice(0, this.movable).entries()) {
      const far = Math.hypot(place[0] - x, place[1] - y);
      if (far < nearest) [nearest, found] = [far, k];
    }
    return found;
  }

  /** @param {number} factor @param {Place} at stays where it is */
  zoomBy(factor, at = this.middle) {
    const before = this.scale;
    const most = (MOST * this.zoom) / this.scale;
    this.zoom = Math.min(Math.max(this.zoom * factor, 1), Math.max(most, 1));
    const share = before / this.scale;
    this.lookAt([
      at[0] + (this.middle[0] - at[0]) * share,
      at[1] + (this.middle[1] - at[1]) * share,
    ]);
  }

  /**
   * Have a pixel in the middle, as far as the picture goes, with no more room around it than the whole
   * picture has: zooming keeps what the pointer is at.
   * @param {Place} place
   */
  lookAt([x, y]) {
    const { film, canvas, scale } = this;
    if (!film) return;
    const clip = (
      /** @type {number} */ value,
      /** @type {number} */ all,
      /** @type {number} */ side, // css px
    ) => {
      const room = Math.max(side - (all * scale) / this.zoom, 0) / 2;
      const least = Math.min((side / 2 - room) / scale, all / 2);
      return Math.min(Math.max(value, least), all - least);
    };
    this.middle = [
      clip(x, film.width, canvas.clientWidth),
      clip(y, film.height, canvas.clientHeight),
    ];
    this.draw();
  }

  /** Have a place in sight. @param {Place} place */
  keepInSight([x, y]) {
    const { canvas, scale, middle } = this;
    const isSeen =
      Math.abs(x - middle[0]) < (0.35 * canvas.clientWidth) / scale &&
      Math.abs(y - middle[1]) < (0.35 * canvas.clientHeight) / scale;
    if (!isSeen) this.lookAt([x, y]);
  }

  draw() {
    const { canvas, film } = this;
    const context = size(canvas, canvas.clientWidth, canvas.clientHeight);
    if (!film || !canvas.clientWidth) return;
    this.paint(context, this.middle, this.scale, [canvas.clientWidth, canvas.clientHeight]);
  }

  /**
   * @param {CanvasRenderingContext2D} context @param {Place} middle @param {number} scale
   * @param {[number, number]} sides css px
   */
  paint(context, middle, scale, [width, height]) {
    const film = /** @type {Film} */ (this.film);
    const put = (/** @type {Place} */ [x, y]) =>
      /** @type {Place} */ ([
        width / 2 + (x - middle[0]) * scale,
        height / 2 + (y - middle[1]) * scale,
      ]);
    context.imageSmoothingEnabled = scale < SHARP;
    const [left, top] = put([0, 0]);
    context.drawImage(film.canvas, left, top, film.width * scale, film.height * scale);
    const { marks, path } = this.overlay;
    paintPath(context, path.map(put));
    const { held } = this;
    const shown = marks.map((each, k) =>
      held?.taken === k ? { ...each, place: held.place } : each,
    );
    const ends = shown.filter(({ aim }) => aim === "length").map(({ place }) => put(place));
    if (ends.length === 2) paintLine(context, ends, COLORS.length, 2);
    for (const { place, aim } of shown) paintMark(context, put(place), aim);
  }

  /** @param {PointerEvent} event */
  showLoupe(event) {
    const place = this.locate(event);
    const { left, top, width } = this.canvas.getBoundingClientRect();
    const isLeft = event.clientX - left < width / 2 && event.clientY - top < LOUPE + 20;
    Object.assign(
      this.loupe.style,
      isLeft ? { left: "auto", right: "6px" } : { left: "6px", right: "auto" },
    );
    this.loupe.hidden = false;
    const context = size(this.loupe, LOUPE, LOUPE);
    this.paint(context, place, Math.max(LARGER, 2 * this.scale), [LOUPE, LOUPE]);
    const half = LOUPE / 2;
    const arms = [8, half - 3];
    for (const [x, y] of [
      [1, 0],
      [-1, 0],
      [0, 1],
      [0, -1],
    ])
      paintLine(
        context,
        arms.map((each) => /** @type {Place} */ ([half + x * each, half + y * each])),
        COLORS.ball,
        1.5,
      );
  }
}

/** A canvas of so many css px, empty. @param {HTMLCanvasElement} canvas @param {number} width @param {number} height */
const size = (canvas, width, height) => {
  const ratio = devicePixelRatio;
  Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.scale(ratio, ratio);
  return context;
};

/** With a dark edge, so that it is seen over any picture. @param {CanvasRenderingContext2D} context @param {Path2D} path @param {string} color @param {number} wide */
const stroke = (context, path, color, wide) => {
  for (const [style, width] of /** @type {[string, number][]} */ ([
    [DARK, wide + 1.5],
    [color, wide],
  ])) {
    Object.assign(context, { strokeStyle: style, lineWidth: width, lineCap: "round" });
    context.stroke(path);
  }
};

/** @param {CanvasRenderingContext2D} context @param {Place[]} places @param {string} color @param {number} wide */
const paintLine = (context, places, color, wide) => {
  const path = new Path2D();
  for (const [x, y] of places) path.lineTo(x, y);
  stroke(context, path, color, wide);
};

/** @param {CanvasRenderingContext2D} context @param {Place[]} places */
const paintPath = (context, places) => {
  if (places.length) paintLine(context, places, COLORS.path, 1.5);
};

/** @type {{[aim: string]: number}} css px; others are crosses or dots */
const RINGS = { ball: 9, suggestion: 9, motion: 4, length: 4 };
const DOT = 1.5; // css px

/** @param {CanvasRenderingContext2D} context @param {Place} place @param {Shown["aim"]} aim */
const paintMark = (context, [x, y], aim) => {
  const path = new Path2D();
  if (aim === "pivot")
    for (const [a, b] of [
      [ARM, 0],
      [0, ARM],
    ]) {
      path.moveTo(x - a, y - b);
      path.lineTo(x + a, y + b);
    }
  else if (aim in RINGS) path.arc(x, y, RINGS[aim], 0, 2 * Math.PI);
  context.setLineDash(aim === "suggestion" ? [4, 4] : []);
  stroke(context, path, COLORS[aim], 2);
  context.setLineDash([]);
  if (aim === "ball" || aim === "other") paintDot(context, x, y, COLORS[aim]);
};

/** @param {CanvasRenderingContext2D} context @param {number} x @param {number} y @param {string} color */
const paintDot = (context, x, y, color) => {
  for (const [style, radius] of /** @type {[string, number][]} */ ([
    [DARK, DOT + 0.7],
    [color, DOT],
  ])) {
    context.fillStyle = style;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
  }
};
