// The history of a run: what was done, in words.

import { writeShort } from "./links.js";

/** @typedef {import("./run.js").Run} Run */
/** @typedef {import("./run.js").Moment} Moment */

const LISTED = 10; // entries

/**
 * What was asked for. An event of a log or of a node does not say it in words.
 * @param {Moment} moment
 * @returns {string}
 */
const nameEvent = ({ kind, asked: { request, act = {} }, course: { start } }) => {
  if (request) return request;
  if (act.precession_rate_factor !== undefined) {
    const factor = act.precession_rate_factor;
    return `${factor > 1 ? "hurried" : "delayed"}: phi' times ${writeShort(factor)}`;
  }
  if (act.angular_impulse) return "pushed by an impulse";
  const { phi, psi } = start.rates;
  if (kind === "kick") return `phi' set to ${writeShort(phi)}`;
  if (kind === "change") return "the top was changed";
  const theta = writeShort(start.angles.theta);
  return `started: theta ${theta}, phi' ${writeShort(phi)}, psi' ${writeShort(psi)}`;
};

/**
 * The last events: their places in the run, and what was asked for.
 * @param {Run} run
 * @returns {[number, string][]}
 */
export const listHistory = ({ moments }) => {
  const places = moments
    .map((_, place) => place)
    .filter((place) => moments[place].kind !== "torque");
  return places
    .slice(-LISTED)
    .reverse()
    .map((place) => [place, nameEvent(moments[place])]);
};
