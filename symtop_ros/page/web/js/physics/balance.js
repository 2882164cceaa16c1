// The moment of gravity by which a top precesses steadily, from what is seen: tilt, spin and the time of one
// turn. As of the Earth, whose torque nobody has weighed.

/** @import { Top } from "./kernel.js" */

const LARGEST = 1e100; // J, of what the kernel takes
/** The question, by the names of what is known. */
export const BALANCE = "theta psi_dot precession_period";

/**
 * Mgl in J of a regular precession: theta'' is 0.
 * @param {{Ix: number, Iz: number}} moments @param {number} theta @param {number} spin psi' @param {number} rate phi'
 */
export const findBalance = ({ Ix, Iz }, theta, spin, rate) =>
  rate * (Iz * spin - (Ix - Iz) * rate * Math.cos(theta));

/**
 * The least and the most of it, if each number may be off by something. It is linear in the spin and in the
 * cosine of the tilt, and square in the rate.
 * @param {{Ix: number, Iz: number}} moments @param {number[]} known @param {number[]} halves @param {number} sense
 */
const findEnds = (moments, known, halves, sense) => {
  const [tilts, spins, times] = known.map((each, k) => [each - halves[k], each + halves[k]]);
  const ends = times.map((each) => (sense * 2 * Math.PI) / each);
  const found = tilts.flatMap((theta) =>
    spins.flatMap((spin) => {
      const level = (moments.Iz * spin) / (2 * (moments.Ix - moments.Iz) * Math.cos(theta));
      const isBetween = level > Math.min(...ends) && level < Math.max(...ends);
      const rates = isBetween ? [...ends, level] : ends;
      return rates.map((rate) => findBalance(moments, theta, spin, rate));
    }),
  );
  return [Math.min(...found), Math.max(...found)];
};

/** What a number would have to be, as of the other questions. @param {number[]} known @param {number[]} weights */
const findDemand = ([theta, , period], weights) => {
  if (!(theta > 0 && theta < Math.PI))
    return { demand: "between", which: 0, least: 0, most: Math.PI };
  if (!(period > 0)) return { demand: "positive", which: 2, least: NaN, most: NaN };
  if (weights.every((each) => Math.abs(each) <= LARGEST)) return null;
  return { demand: "rates", which: 2, least: NaN, most: NaN };
};

/**
 * The steady motions with a tilt, a spin and a time of one turn, in both senses, each with its Mgl; or what a
 * number would have to be.
 * @param {Top} top @param {number[]} known @param {number[]} halves half a unit of the last digit of each
 */
export const solveBalance = (top, known, halves) => {
  const [theta, psi_dot, period] = known;
  const rates = [1, -1].map((sense) => (sense * 2 * Math.PI) / period);
  const weights = rates.map((rate) => findBalance(top, theta, psi_dot, rate));
  const refused = findDemand(known, weights);
  if (refused) return { ...refused, starts: [] };
  const starts = rates.map((phi_dot, k) => {
    const start = { theta, theta_dot: 0, phi_dot, psi_dot, Mgl: weights[k] };
    const [least, most] = findEnds(top, known, halves, Math.sign(phi_dot));
    return { start, least: { ...start, Mgl: least }, most: { ...start, Mgl: most } };
  });
  return { demand: "", which: 0, least: NaN, most: NaN, starts };
};
