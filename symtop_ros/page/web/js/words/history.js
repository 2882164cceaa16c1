// The history of a run: what was asked for, as records for the templates `request`.

import { isKnown, phrase } from "./wording.js";

/** @import { Run, Asked } from "../run/run.js" */
/** @import { Course } from "../physics/course.js" */
/** @import { Variant } from "./wording.js" */

const LISTED = 10; // entries

/**
 * What was asked for, as far as the event itself says it.
 * @param {import("../run/run.js").Kind} kind
 * @param {Asked} asked
 * @param {Course} course that followed
 */
const findRequest = (kind, { act = {}, hold }, { start }) => {
  const { phi: phi_dot, psi: psi_dot } = start.rates;
  const { precession_rate_factor: factor, precession_rate_change: change, axle_impulse } = act;
  if (kind === "change") return { kind: "change" };
  if (kind === "clamp" || kind === "unclamp") return { kind };
  if (kind === "push") return { kind: "sideways", rate: act.rate };
  if (kind !== "kick") return { kind: "started", theta: start.angles.theta, phi_dot, psi_dot };
  if (factor !== undefined) return { kind: factor > 1 ? "hurried" : "delayed", factor, hold };
  if (axle_impulse !== undefined) return { kind: axle_impulse < 0 ? "back" : "along" };
  if (change !== undefined) return { kind: change > 0 ? "along" : "back" };
  if (act.angular_impulse) return { kind: "impulse" };
  if (act.precession_rate !== undefined) return { kind: "rate", phi_dot };
  throw new RangeError(`a kick must be one that has words, got ${Object.keys(act).join(", ")}`);
};

/**
 * What was asked for, in words: in those of the page that made it, if it kept no more.
 * @param {import("../run/run.js").Moment} moment
 * @param {Variant} variant
 */
const nameRequest = ({ kind, asked, course }, variant) => {
  const { made_by: maker, request } = asked;
  if (maker?.kind === "scene") {
    const title = `scene.${maker.name}.title`;
    if (isKnown(title)) return phrase(title); // another version may have other scenes
  } else if (maker) return phrase("request", maker);
  return request ?? phrase("request", findRequest(kind, asked, course), variant);
};

/**
 * The last events: their places in the run, and what was asked for.
 * @param {Run} run @param {Variant} variant @returns {[number, string][]}
 */
export const listHistory = ({ moments }, variant) =>
  moments
    .filter(({ kind }) => kind !== "torque")
    .slice(-LISTED)
    .reverse()
    .map((event) => [moments.indexOf(event), nameRequest(event, variant)]);
