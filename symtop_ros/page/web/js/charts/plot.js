// Axes and curves of a chart, as SVG.

import { find } from "../controls/document.js";
import { shorten } from "../words/quantities.js";
import { speakText } from "../words/spoken.js";

export const WIDE = 300; // units of the drawing
export const LEFT = 44; // of the axes
const [RIGHT, UPPER, LOWER] = [18, 21, 28]; // margins, in which all words are
const FAR = 1e4; // units; out of the drawing
const DIGITS = 5; // of a number at an axis
const LETTER = 5.6; // units of its width
const DOT = 5; // units of its radius: no number is below it at the left edge

/** A number at an axis, with a minus sign. @param {number} value */
const writeTick = (value) => shorten(value, DIGITS).replace(/^-/, "\u2212");

/** @typedef {[number, number]} Pair */
/** @typedef {(value: number) => number} Scale */

/**
 * Put a drawing into the place of a chart.
 * @param {string} id
 * @param {number} height
 * @param {string} drawing
 * @param {string} [label] if it is not always the same
 */
export const draw = (id, height, drawing, label) => {
  const svg = /** @type {Element} */ (find(id).firstElementChild);
  svg.setAttribute("viewBox", `0 0 ${WIDE} ${height}`);
  svg.innerHTML = drawing;
  if (label) svg.ariaLabel = speakText(label);
};

/** Round values between two, about so many. @param {number} low @param {number} high @param {number} count */
const listTicks = (low, high, count) => {
  const rough = (high - low) / count;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * size).find((each) => each >= rough * 0.999) ?? rough;
  // Of values far larger than their span some are equal: a loop that counts up to `high` may not end.
  const first = Math.ceil(low / step);
  const found = Array.from({ length: count + 2 }, (_, k) => (first + k) * step);
  // Each stands where the number is that is written at it.
  const written = new Set(found.map((value) => Number(value.toPrecision(DIGITS))));
  return [...written].filter((value) => value >= low && value <= high);
};

/**
 * The place of a value, outside of the drawing if the value is beyond what an axis can show; NaN, a
 * gap, for a value that is no number.
 * @param {number} value @param {number} place
 */
const keepNear = (value, place) => {
  if (Number.isNaN(place)) return Number.isNaN(value) ? NaN : FAR;
  return Math.min(Math.max(place, -FAR), FAR);
};

/** A path through points, with gaps where their height is no number. @param {Pair[]} points */
const writePath = (points) => {
  let text = "";
  let pen = "M";
  for (const [x, y] of points) {
    if (Number.isFinite(y)) text += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = Number.isFinite(y) ? "L" : "M";
  }
  return text;
};

/**
 * Places for words below a chart, in order: apart by half a letter, and inside the drawing.
 * @param {number[]} places wanted @param {string[]} texts
 */
const spreadWords = (places, texts) => {
  const halves = texts.map((each) => (LETTER * each.length) / 2);
  const found = texts.map((_, k) => places[k]);
  for (let k = 1; k < found.length; k += 1) {
    const lack = found[k - 1] + halves[k - 1] + LETTER / 2 + halves[k] - found[k];
    if (lack <= 0) continue;
    found[k - 1] -= k === 1 ? lack / 2 : 0; // of two both give way
    found[k] += k === 1 ? lack / 2 : lack;
  }
  let end = WIDE - 1;
  for (let k = found.length - 1; k >= 0; k -= 1) {
    found[k] = Math.min(found[k], end - halves[k]);
    end = found[k] - halves[k] - LETTER / 2;
  }
  return found;
};

/** The axes of a chart, and what is drawn in it: values become units of the drawing. */
export class Frame {
  /**
   * @param {number} height
   * @param {Pair} horizontal values at the left and at the right edge
   * @param {Pair} vertical values at the lower and at the upper edge, in this order
   * @param {number} marks
   * @param {Scale} shown a value in the unit of the page
   */
  constructor(height, horizontal, vertical, marks = 4, shown = (value) => value) {
    const [[left, right], [low, high]] = [horizontal, vertical];
    this.horizontal = horizontal;
    this.bottom = height - LOWER;
    /** @type {Scale} */
    this.x = (value) =>
      keepNear(value, LEFT + ((value - left) / (right - left)) * (WIDE - LEFT - RIGHT));
    /** @type {Scale} */
    this.y = (value) =>
      keepNear(value, this.bottom - ((value - low) / (high - low)) * (this.bottom - UPPER));
    const ticks = listTicks(shown(Math.min(low, high)), shown(Math.max(low, high)), marks);
    this.axes = ticks.map((value) => this.drawTick(value, value / (shown(1) || 1))).join("");
  }

  /** @param {number} text @param {number} value */
  drawTick(text, value) {
    const number = writeTick(text);
    const most = LEFT - DOT - 4;
    const isLong = LETTER * number.length > most; // all of it is seen
    const size = isLong ? ` textLength="${most}" lengthAdjust="spacingAndGlyphs"` : "";
    return `${this.level(value, 'class="axis"')}
      <text class="tick" x="${LEFT - DOT - 2}" y="${(this.y(value) + 3).toFixed(1)}" text-anchor="end"${size}>${number}</text>`;
  }

  /** @param {Pair} point @returns {Pair} */
  place([x, y]) {
    return [this.x(x), this.y(y)];
  }

  /** A line across the chart. @param {number} value @param {string} style */
  level(value, style) {
    return `<path d="M${LEFT} ${this.y(value).toFixed(1)}H${WIDE - RIGHT}" ${style}/>`;
  }

  /**
   * A curve, with gaps where its height is no number.
   * @param {Pair[]} points @param {string} style @param {string} fill of what it goes round
   */
  curve(points, style, fill = "none") {
    return `<path d="${writePath(points.map((each) => this.place(each)))}" fill="${fill}" ${style}/>`;
  }

  /** A drawing of which only what is within the axes is seen. @param {string} drawing */
  clip(drawing) {
    const box = `${LEFT} ${UPPER} ${WIDE - LEFT - RIGHT} ${this.bottom - UPPER}`;
    const [x, y, width, height] = box.split(" ");
    return `<svg x="${x}" y="${y}" width="${width}" height="${height}" viewBox="${box}">${drawing}</svg>`;
  }

  /** A line from the upper to the lower edge. @param {number} value @param {string} style */
  upright(value, style) {
    return `<path d="M${this.x(value).toFixed(1)} ${UPPER}V${this.bottom}" ${style}/>`;
  }

  /** A band between two values of the horizontal axis. @param {Pair} ends @param {string} style */
  band([low, high], style) {
    const [left, right] = [this.x(low), this.x(high)];
    const width = Math.max(right - left, 1).toFixed(1);
    return `<rect x="${left.toFixed(1)}" y="${UPPER}" width="${width}" height="${this.bottom - UPPER}" ${style}/>`;
  }

  /** Many small dots. @param {Pair[]} points @param {string} style */
  dots(points, style) {
    const path = points.map(
      (each) =>
        `M${this.place(each)
          .map((part) => part.toFixed(1))
          .join(" ")}h0`,
    );
    return this.clip(
      `<path d="${path.join("")}" stroke="var(--dim)" stroke-width="3.4" stroke-linecap="round" ${style}/>`,
    );
  }

  /** @param {Pair} point @param {string} style */
  dot(point, style) {
    const [x, y] = this.place(point).map((each) => each.toFixed(1));
    return `<circle cx="${x}" cy="${y}" r="${DOT}" ${style}/>`;
  }

  /** What the vertical axis shows, above it. @param {string} text */
  nameVertical(text) {
    return `<text x="4" y="11">${text.replace("<", "&lt;")}</text>`;
  }

  /** What the horizontal axis shows, below its values. @param {string} text @param {string} values */
  nameHorizontal(text, values = this.writeBelow(listTicks(...this.horizontal, 4))) {
    const name = `<text x="${WIDE - RIGHT}" y="${this.bottom + 24}" text-anchor="end">${text}</text>`;
    return name + values;
  }

  /** The name of a level, at its right end. @param {number} value @param {string} text */
  nameLevel(value, text) {
    return `<text x="${WIDE - RIGHT + 3}" y="${(this.y(value) + 4).toFixed(1)}">${text}</text>`;
  }

  /** Values below the axes. @param {number[]} values @param {(value: number) => string} write */
  writeBelow(values, write = writeTick) {
    const place = `y="${this.bottom + 12}" text-anchor="middle"`;
    const texts = values.map(write).filter((each, k, all) => each !== all[k - 1]);
    return spreadWords(values.map(this.x), texts)
      .map((x, k) => `<text class="tick" x="${x.toFixed(1)}" ${place}>${texts[k]}</text>`)
      .join("");
  }
}

/**
 * An interval around numbers, with some room; of `least` at least, so that no rounding is shown.
 * @param {number[]} numbers @param {number} least @returns {Pair}
 */
export const findSpan = (numbers, least) => {
  let [low, high] = [Infinity, -Infinity];
  for (const value of numbers) {
    if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  }
  if (low > high) return [0, 1];
  const more = Math.max(0.06 * (high - low), (least - (high - low)) / 2, 1e-9);
  return [low - more, high + more];
};
