// Numbers of a motion that was fitted, each with its deviation: twin of truth/fit/values.py.

import { Valley } from "./valley.js";

/** @import { Fit } from "./refine.js" */
/** @typedef {{name: string, value: number, deviation: number, unit: string, is_known: boolean, is_straight: boolean}} Value */
/** @typedef {(x: number[]) => number} Of a number of the parameters */

const SURE = 0.15; // of the scale of a number; one with a larger deviation is not known
const LEVEL = 4; // deviations within which an elevation may be zero
export const SPARSE = 4; // rows in a nutation, below which a different motion may show the same rows
const NYQUIST = 2; // rows in a nutation, more than which are assumed of two motions that fit as well
const SIDES = ["p_psi/Ix", "phi_dot", "mean_precession_rate"]; // change with the sign of p_psi
export const ALIASED = ["Mgl/Ix", "p_psi/Ix", "theta_dot", "phi_dot", "nutation_period"];
const STEP = 1e-6; // of differences, in scales of the parameters
/** @type {{[name: string]: string}} */
const UNITS = {
  "Mgl/Ix": "1/s^2",
  "p_psi/Ix": "rad/s",
  theta: "rad",
  phi: "rad",
  theta_dot: "rad/s",
  phi_dot: "rad/s",
  mean_precession_rate: "rad/s",
  nutation_period: "s",
  scale: "pixels",
  u: "pixels",
  v: "pixels",
  elevation: "rad",
  roll: "rad",
  nearness: "",
};
const WHOLE = ["phi", "roll"]; // known but for whole turns

/** @param {number} angle */
const dropTurns = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

/** The numbers of a fit as functions of the parameters, by name. @param {Fit} fit @returns {[string, Of][]} */
const listQuantities = ({ model, x }) => {
  const { many, place } = model;
  const find =
    (/** @type {"phi" | "theta" | "phi_dot" | "theta_dot"} */ name) =>
    (/** @type {number[]} */ y) =>
      many.findAngles(model.read(y))[name];
  const rate = (/** @type {string} */ name) => (/** @type {number[]} */ y) => {
    try {
      return many.findRates(model.read(y))[name];
    } catch {
      return Number.NaN;
    }
  };
  const { phi } = many.findAngles(model.read(x));
  const turn = (/** @type {number[]} */ y) => phi + dropTurns(find("phi")(y) - phi);
  const angles = /** @type {const} */ (["theta_dot", "phi_dot"]).map((name) => {
    return /** @type {[string, Of]} */ ([name, find(name)]);
  });
  const take = (/** @type {string} */ name) =>
    /** @type {[string, Of]} */ ([name, (y) => y[place[name]]]);
  const camera = ["u", "v", "log_scale", "elevation", "roll", "nearness"].filter(
    (each) => each in place,
  );
  return [
    take("Mgl/Ix"),
    take("p_psi/Ix"),
    ["theta", find("theta")],
    ["phi", turn],
    ...angles,
    ["mean_precession_rate", rate("mean_precession_rate")],
    ["nutation_period", rate("nutation_period")],
    ...camera.map((name) =>
      name === "log_scale"
        ? /** @type {[string, Of]} */ (["scale", (y) => Math.exp(y[place[name]])])
        : take(name),
    ),
  ];
};

/** The number of rows in a nutation; infinite if theta does not return. @param {Fit} fit */
export const countRows = ({ model, x }) =>
  model.many.findRates(model.read(x)).nutation_period / model.record.step;

/**
 * Whether a motion that fits as well has too few rows in a nutation, and the fit enough: as everywhere in
 * sampling, the slower motion is taken, unless the rows say otherwise.
 * @param {Fit} rival @param {Fit} fit
 */
export const isAlias = (rival, fit) => countRows(rival) <= NYQUIST && countRows(fit) >= SPARSE;

/** Whether a camera may be above or below the level of the pivot. @param {Fit} fit */
export const isLevel = (fit) => {
  const place = fit.model.place.elevation;
  const isOpen = fit.hasMirror || !fit.model.record.hasPerspective;
  if (place === undefined || !isOpen) return false;
  const deviation = fit.findDeviation(fit.x.map((_, k) => Number(k === place)));
  return Math.abs(fit.x[place]) < LEVEL * deviation;
};

/** What the record shows; a number that a twin has with a different value is not known. @param {Fit} fit @returns {Value[]} */
export const listValues = (fit) => {
  const rivals = fit.others.filter((other) => !isAlias(other, fit));
  const others = rivals.map((other) => ({ other, of: Object.fromEntries(listQuantities(other)) }));
  const hidden = [
    ...(isLevel(fit) ? [...SIDES, "phi", "elevation"] : []),
    ...(countRows(fit) < SPARSE ? ALIASED : []),
  ];
  const valley = new Valley(fit);
  return listQuantities(fit).map(([name, of]) => {
    const value = findValue(valley, name, of);
    const isSame = others.every((each) => agree(value, each.of[name](each.other.x)));
    return isSame && !hidden.includes(name) ? value : { ...value, is_known: false };
  });
};

/** Whether a number of another motion is within three deviations. @param {Value} value @param {number} rival */
const agree = ({ name, value, deviation }, rival) => {
  const left = WHOLE.includes(name) ? dropTurns(rival - value) : rival - value;
  return Math.abs(left) <= 3 * deviation;
};

/** @param {Valley} valley @param {string} name @param {Of} of @returns {Value} */
const findValue = (valley, name, of) => {
  const { fit } = valley;
  const [slope, value] = [findSlope(fit, of), of(fit.x)];
  const found = { name, value, unit: UNITS[name] };
  if (![value, ...slope].every(Number.isFinite))
    return { ...found, deviation: Infinity, is_known: false, is_straight: true };
  const deviation = fit.findDeviation(slope);
  const isSmall = deviation <= SURE * findScale(fit, name, value);
  const is_straight = !isSmall || valley.isStraight(slope, of);
  return { ...found, deviation, is_known: isSmall && is_straight, is_straight };
};

/** The derivatives of a number. @param {Fit} fit @param {Of} of */
export const findSlope = ({ model, x }, of) =>
  model.findScales(x).map((scale, k) => {
    const [high, low] = [1, -1].map((side) =>
      of(x.map((each, j) => (j === k ? each + side * STEP * scale : each))),
    );
    return (high - low) / (2 * STEP * scale);
  });

/** The size of a number, below which its deviation has to be. @param {Fit} fit @param {string} name @param {number} value */
const findScale = ({ model, x }, name, value) => {
  if (["nutation_period", "scale"].includes(name)) return Math.abs(value);
  const scales = model.findScales(x);
  if (["theta", "phi"].includes(name)) return 1;
  return scales[model.place[name] ?? model.place.wx];
};
