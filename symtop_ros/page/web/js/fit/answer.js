// What is said of a fit, as data, and the motion with its points as a run.

import { checkFit } from "./check.js";
import { ORDERS } from "./whitening.js";
import { listUnknown } from "./unknown.js";
import { CAMERA, rectify } from "./projection.js";
import { LENGTH } from "./model.js";
import { listValues } from "./values.js";

/** @import { Change, Verdict } from "./check.js" */
/** @import { Camera } from "./projection.js" */
/** @import { Fit } from "./refine.js" */
/** @import { Top } from "../physics/kernel.js" */
/** @import { Unknown } from "./unknown.js" */
/** @import { Value } from "./values.js" */
/**
 * A fit for people: rows that were taken and kept, the numbers, whether the model holds and why not, the
 * order of an autoregression of noise, what cannot be known, what of the record this search does not
 * allow for and `top_fit` does, what is left of all rows, and the run with the numbers that are assumed.
 * @typedef {{kind: "axis" | "pixels", rows: number, kept: number, outliers: number[], values: Value[],
 *   verdict: Verdict, reasons: Reason[], order: number, is_flicker: boolean, unknown: Unknown[],
 *   limits: string[], residuals: number[][], sigma: number[], times: number[], run: any,
 *   assumed: {name: string, value: number, unit: string}[]}} Fitted
 */
/** Why the model is in doubt or wrong. @typedef {{kind: string, changes?: Change[], count?: number}} Reason */

/** @param {Fit} fit @param {Top} top whose moments stand for those that no record of an axis shows @returns {Fitted} */
export const describeFit = (fit, top) => {
  const { model, noise } = fit;
  const { record } = model;
  const check = checkFit(fit);
  const values = listValues(fit);
  const kept = new Set(noise.kept);
  return {
    kind: record.kind,
    rows: record.count,
    kept: noise.kept.length,
    outliers: Array.from(record.times, (_, row) => row).filter((row) => !kept.has(row)),
    values,
    verdict: check.verdict,
    reasons: listReasons(check, fit),
    order: noise.partial[0].length,
    is_flicker: noise.partial[0].length > ORDERS,
    unknown: listUnknown(fit, values),
    limits: listLimits(check, fit),
    residuals: splitRows(fit.residuals, record.width),
    sigma: noise.sigma,
    times: [...record.times],
    ...makeRun(fit, top),
  };
};

/** @param {ReturnType<typeof checkFit>} check @param {Fit} fit @returns {Reason[]} */
const listReasons = ({ is_white, is_smooth, swings, changes, stretch, fault }, fit) => [
  ...(changes.length ? [{ kind: "changes", changes }] : []),
  ...(swings ? [{ kind: "swings" }] : []),
  ...(is_smooth ? [{ kind: "smooth" }] : []),
  ...(is_white ? [] : [{ kind: "lasting" }]),
  ...(stretch ? [{ kind: "stretch", count: stretch }] : []),
  ...(fault ? [{ kind: fault }] : []),
  ...(fit.isLone ? [{ kind: "lone" }] : []),
];

/** What top_fit allows for and this search does not. @param {ReturnType<typeof checkFit>} check @param {Fit} fit */
const listLimits = ({ verdict, swings }, fit) => [
  ...(verdict === "holds" && !fit.lasts ? [] : ["friction", "kick"]),
  ...(swings ? ["lines"] : []),
  ...(fit.model.record.count < fit.model.record.given.times.length ? ["rows"] : []),
];

/** @param {Float64Array} flat @param {number} width */
const splitRows = (flat, width) =>
  Array.from({ length: flat.length / width }, (_, row) => [
    ...flat.slice(row * width, (row + 1) * width),
  ]);

/** The motion in kg m^2 with the points, as run.json: twin of truth/fit/runs.py. @param {Fit} fit @param {Top} top */
const makeRun = ({ model, x, residuals }, top) => {
  const { record } = model;
  const { weight, q, omega } = model.read(x);
  const norm = Math.hypot(...q);
  const length = record.hasLength ? Math.exp(x[model.place[LENGTH]]) : 1;
  const divide = (/** @type {number[]} */ row) => row.map((each) => each / length);
  const camera = record.kind === "pixels" ? model.findCamera(x) : null;
  const level = (/** @type {number[]} */ row) => (camera ? rectify(row, camera) : divide(row));
  const rows = splitRows(residuals, record.width);
  const values = record.values.map(level);
  const start = {
    kind: "start",
    time: 0,
    top: [top.Ix, top.Iz, weight * top.Ix],
    orientation: q.map((each) => each / norm),
    angular_velocity: [omega[0], omega[1], (omega[2] * top.Ix) / top.Iz],
    friction: [0, 0],
    torque: [0, 0, 0],
  };
  const points = {
    kind: record.kind,
    rows: record.given.times.length,
    times: [...record.times],
    values,
    residuals: record.values.map((row, k) => {
      const shown = level(row.map((each, n) => each + rows[k][n]));
      return values[k].map((each, n) => each - shown[n]);
    }),
    ...(camera ? { camera: pickCamera(camera) } : {}),
  };
  const assumed = [
    { name: "Iz/Ix", value: top.Iz / top.Ix, unit: "" },
    { name: "Ix", value: top.Ix, unit: "kg m^2" },
  ];
  return { run: { format: 5, events: [start], end: record.seconds, points }, assumed };
};

/** Its numbers for a run, whose points are those of a camera that looks at the pivot. @param {Camera} camera */
const pickCamera = (camera) => Object.fromEntries(CAMERA.map((name) => [name, camera[name]]));
