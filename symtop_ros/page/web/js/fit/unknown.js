// Statements on what a record cannot show, and why: twin of truth/fit/unknown.py.
//
// A twin is named only if it was computed and shows the same points to rounding.

import { dot } from "./linear.js";
import { whiten } from "./noise.js";
import { project } from "./projection.js";
import { mirrorPicture, mirrorView, seeFromAbove, turnCamera } from "./twins.js";
import { ALIASED, SPARSE, countRows, findSlope, isAlias, isLevel } from "./values.js";

/** @import { Camera } from "./projection.js" */
/** @import { Thrown } from "./many.js" */
/** @import { Fit } from "./refine.js" */
/** @import { Value } from "./values.js" */
/** One statement, whose words are those of the template `unknown.KIND`. @typedef {{kind: string, names: string, numbers: number[]}} Unknown */

const EXACT = 1e-9; // of the size of a record
const STRONG = 0.98; // correlation of two numbers that are only known together
const ABOVE_PIVOT = 0.5; // of the axis: where a camera looks whose aim is not known
const ABOVE = 4; // deviations within which a camera may be straight above

/** @param {Fit} fit @param {Value[]} values @returns {Unknown[]} */
export const listUnknown = (fit, values) => {
  const together = listTogether(fit, values);
  const found = [...listTwins(fit), ...together, ...listAmbiguities(fit, values)];
  const said = found.flatMap(({ names }) => names.split(", "));
  const curved = values.filter((each) => !each.is_straight && !said.includes(each.name));
  if (curved.length)
    found.push({ kind: "curved", names: curved.map(({ name }) => name).join(", "), numbers: [] });
  const paired = together.flatMap(({ names }) => names.split(" and "));
  const named = found.flatMap(({ names }) => names.split(", "));
  for (const { name, value, deviation, is_known } of values)
    if (!is_known && Number.isFinite(deviation) && !paired.includes(name) && !named.includes(name))
      found.push({ kind: "weak", names: name, numbers: [value, deviation] });
  // along a combination that alone is known there is a motion for each of its values
  const others = together.length ? [] : fit.others;
  for (const other of others) {
    const { weight, omega } = other.model.read(other.x);
    const numbers = [weight, omega[2]];
    if (isAlias(other, fit))
      found.push({
        kind: "alias",
        names: "rows",
        numbers: [...numbers, countRows(other)],
      });
    else found.push({ kind: "other", names: "Mgl/Ix, p_psi/Ix", numbers });
  }
  return found;
};

/** Exact twins: those of any record of an axis, and those that a camera shows as well. @param {Fit} fit @returns {Unknown[]} */
const listTwins = (fit) => {
  const { model, x } = fit;
  // The parameters hold neither a moment alone nor the spin: the model is the same for all of them.
  const always = [
    { kind: "moments", names: "Ix, Iz, Mgl", numbers: [] },
    { kind: "spin", names: "Iz/Ix, spin", numbers: [] },
  ];
  if (model.record.kind !== "pixels") return always;
  const [motion, camera] = [model.read(x), model.findCamera(x)];
  const [p, weight] = [motion.omega[2], motion.weight];
  const [over, low] = [turnCamera(motion, camera), mirrorView(motion, camera)];
  const level = { ...camera, elevation: Math.PI / 2 };
  const mirrored = mirrorPicture(motion, camera);
  /** @type {[Unknown, Seen, Seen][]} */
  const twins = [
    [
      { kind: "mirrored", names: "sign of p_psi", numbers: [-p] },
      { motion, camera },
      { ...mirrored, isMirrored: true },
    ],
    [{ kind: "upright", names: "sign of Mgl", numbers: [-weight, p] }, { motion, camera }, over],
    [
      { kind: "high", names: "sign of p_psi", numbers: [low.camera.elevation, -p] },
      { motion, camera },
      low,
    ],
  ];
  if (isAbove(fit))
    twins.push([
      { kind: "above", names: "sign of Mgl", numbers: [-weight, -p] },
      { motion, camera: level },
      { motion: seeFromAbove(motion), camera: level },
    ]);
  return [
    ...always,
    ...twins.flatMap(([said, own, twin]) =>
      (said.kind === "high" && fit.hasMirror) || isSame(fit, own, twin) ? [said] : [],
    ),
    ...listAim(fit),
  ];
};

/** What p_psi would be if a camera whose aim is not known looks above the pivot. @param {Fit} fit @returns {Unknown[]} */
const listAim = (fit) => {
  const { many, record, place } = fit.model;
  const camera = fit.model.findCamera(fit.x);
  if (!record.hasPerspective || camera.centre) return [];
  const [axes] = many.findAxes([fit.model.read(fit.x)], record.times);
  if (!axes) return [];
  const above = camera.v + ABOVE_PIVOT * Math.exp(camera.log_scale);
  const [first, second] = [
    camera,
    { ...camera, centre: /** @type {const} */ ([camera.u, above]) },
  ].map((each) => project(axes, each, new Float64Array(record.flat.length)));
  // least squares follow what is shown, to first order
  const change = whiten(
    fit.noise,
    first.map((each, k) => each - second[k]),
  );
  const row = fit.covariance[place["p_psi/Ix"]];
  const shift = fit.slopes.columns.reduce((sum, each, k) => sum + row[k] * dot(each, change), 0);
  return [{ kind: "aim", names: "aim", numbers: [fit.x[place["p_psi/Ix"]] + shift] }];
};

/** What is shown; of a mirrored picture left and right are exchanged. @typedef {{motion: Thrown, camera: Camera, isMirrored?: boolean}} Seen */

/** Whether two motions show the same points. @param {Fit} fit @param {Seen} own @param {Seen} twin */
const isSame = ({ model }, own, twin) => {
  const { many, record } = model;
  const axes = many.findAxes([own.motion, twin.motion], record.times);
  const [first, second] = [own, twin].map(({ camera, isMirrored }, k) => {
    const seen = axes[k] && project(axes[k], camera, new Float64Array(record.flat.length));
    return seen?.map((each, n) => (isMirrored && n % 2 === 0 ? 2 * camera.u - each : each));
  });
  if (!first || !second) return false;
  const size = first.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
  return first.every((each, k) => Math.abs(each - second[k]) <= EXACT * size);
};

/** Whether a camera may look straight down. @param {Fit} fit */
const isAbove = (fit) => {
  const place = fit.model.place.elevation;
  const deviation = fit.findDeviation(fit.x.map((_, k) => Number(k === place)));
  return Math.PI / 2 - fit.x[place] < ABOVE * deviation;
};

/** Numbers that are not known, but for a combination of both. @param {Fit} fit @param {Value[]} values @returns {Unknown[]} */
const listTogether = (fit, values) => {
  const { place } = fit.model;
  const doubtful = values.filter(({ is_known }) => !is_known).map(({ name }) => name);
  const turning = values.find(({ name }) => name === "mean_precession_rate");
  /** @type {Unknown[]} */
  const found = [];
  const names = ["Mgl/Ix", "p_psi/Ix"];
  if (names.every((each) => doubtful.includes(each)) && turning?.is_known) {
    const [a, p] = names.map((each) => place[each]);
    const { covariance } = fit;
    const ratio = covariance[a][p] / Math.sqrt(covariance[a][a] * covariance[p][p]);
    const numbers = [turning.value, turning.deviation, ...findRest(fit)];
    if (Math.abs(ratio) > STRONG)
      found.push({ kind: "together", names: names.join(" and "), numbers });
  }
  if (doubtful.includes("scale"))
    found.push({ kind: "tilt", names: "scale and theta", numbers: [] });
  return found;
};

/** What Mgl is more than the mean precession times p_psi, in Ix, and its deviation: any p_psi has it. @param {Fit} fit */
const findRest = (fit) => {
  const { many, place } = fit.model;
  const find = (/** @type {number[]} */ x) => {
    const { mean_precession_rate: turning } = many.findRates(fit.model.read(x));
    return x[place["Mgl/Ix"]] - turning * x[place["p_psi/Ix"]];
  };
  return [find(fit.x), fit.findDeviation(findSlope(fit, find))];
};

/** Nutations with few rows, and level cameras. @param {Fit} fit @param {Value[]} values @returns {Unknown[]} */
const listAmbiguities = (fit, values) => {
  const hidden = ALIASED.filter((name) => values.some((each) => each.name === name)).join(", ");
  const rows = countRows(fit);
  return [
    ...(rows < SPARSE ? [{ kind: "sparse", names: hidden, numbers: [rows] }] : []),
    ...(isLevel(fit) ? [{ kind: "level", names: "sign of p_psi", numbers: [] }] : []),
  ];
};
