// What was measured as a record of a fit, as a table, and as the command that fits it.

/** @import { Clicks, Place } from "./clicks.js" */
/** @typedef {import("../fit/record.js").Given} Given */
/** A number that was typed, with half a unit of its last digit. @typedef {{value: number, half: number}} Typed */
/** Of a length in the picture and of the ball from the pivot, in the same unit. @typedef {{length: Typed, ball: Typed}} Lengths */

const CLICK = 1; // px; deviation of a click
const [TIME, PIXEL] = [7, 2]; // decimals: a tenth of a microsecond, a hundredth of a pixel

/** Without zeros at its end. @param {number} value @param {number} decimals */
const write = (value, decimals) => String(Number(value.toFixed(decimals)));

/** @param {number} value @param {number} decimals */
const round = (value, decimals) => Number(value.toFixed(decimals));

/** u to the right and v upwards. @param {Place} place @param {number} height of the film @returns {[number, number]} */
const turnUp = ([x, y], height) => [round(x, PIXEL), round(height - y, PIXEL)];

/** Pixels from the pivot to the ball, and the deviation of their logarithm. @param {Clicks} clicks @param {Lengths} lengths */
const findScale = ({ length: [from, to] }, { length, ball }) => {
  const pixels = Math.hypot(from[0] - to[0], from[1] - to[1]);
  const parts = [
    (Math.SQRT2 * CLICK) / pixels,
    ...[length, ball].map(({ value, half }) => half / Math.sqrt(3) / value),
  ];
  return { scale: (pixels / length.value) * ball.value, deviation: Math.hypot(...parts) };
};

/**
 * The record of some clicks. The camera looks at the middle of the film.
 * @param {Clicks} clicks @param {{times: number[], width: number, height: number}} film
 * @param {Lengths | null} lengths @param {boolean} perspective @returns {Given}
 */
export const makeGiven = (clicks, { times, width, height }, lengths, perspective) => {
  const frames = [...clicks.balls].sort(([a], [b]) => a - b);
  const [u, v] = clicks.pivot ? turnUp(clicks.pivot, height) : [];
  const scale = lengths && clicks.length.length === 2 ? findScale(clicks, lengths) : null;
  return {
    kind: "pixels",
    times: frames.map(([frame]) => round(times[frame], TIME)),
    values: frames.map(([, place]) => turnUp(place, height)),
    known: {
      ...(u !== undefined && v !== undefined ? { u: [u, CLICK], v: [v, CLICK] } : {}),
      ...(scale ? { log_scale: [Math.log(scale.scale), scale.deviation] } : {}),
    },
    perspective,
    centre: [width / 2, height / 2],
  };
};

/** The record as a table of top_fit. @param {Given} given */
export const writeTable = ({ kind, times, values }) => {
  const rows = times.map((time, k) => [write(time, TIME), ...values[k].map(String)].join(","));
  return `${[kind === "pixels" ? "t,u,v" : "t,x,y,z", ...rows].join("\n")}\n`;
};

/** @param {[number, number]} size ln of the scale, and its deviation */
const writeScale = ([logarithm, deviation]) => {
  const scale = Math.exp(logarithm);
  const [value, spread] = [scale.toPrecision(4), (scale * deviation).toPrecision(2)].map(Number);
  return `--scale ${value} --scale-deviation ${spread}`;
};

/** The command that fits the same record. @param {string} name of the file @param {Given} given */
export const writeCommand = (name, { kind, known = {}, perspective, centre }) => {
  const { u, v, log_scale: size } = known;
  const options = [
    u && v ? `--pivot ${u[0]} ${v[0]} --pivot-deviation ${u[1]}` : "",
    size ? writeScale(size) : "",
    perspective ? "--perspective" : "",
    perspective && centre ? `--centre ${centre.join(" ")}` : "",
  ];
  const file = /^[\w.-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`;
  return [`top_fit ${file} --kind ${kind}`, ...options].filter(Boolean).join(" ");
};
