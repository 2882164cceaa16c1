// Twin of physics/exact/elementary.py: elementary functions with the same bits in every browser.
//
// Sums, products, quotients and roots of doubles round in the same way everywhere; the functions of
// Math do not. These here are made of the former, in the order of Python.

import { Big, LONG } from "./big.js";

const SINE = [
  1 / 355687428096000,
  -1 / 1307674368000,
  1 / 6227020800,
  -1 / 39916800,
  1 / 362880,
  -1 / 5040,
  1 / 120,
  -1 / 6,
];
const VERSINE = [
  -1 / 20922789888000,
  1 / 87178291200,
  -1 / 479001600,
  1 / 3628800,
  -1 / 40320,
  1 / 720,
  -1 / 24,
  1 / 2,
];
const ARC_TANGENT = [-1 / 15, 1 / 13, -1 / 11, 1 / 9, -1 / 7, 1 / 5, -1 / 3];
// A quarter turn as a sum of two doubles, the first of 26 bits; and half of pi as the nearest two.
const QUARTER_HIGH = 1.5707963109016418;
const QUARTER_LOW = 1.5893254773528196e-8;
const QUARTERS = 0.6366197723675814;
const [HALF_PI_HIGH, HALF_PI_LOW] = [1.5707963267948966, 6.123233995736766e-17];
const PI_LOW = 1.2246467991473532e-16;
// Arc tangents of 0 to 8 eighths, as sums of two doubles.
const EIGHTHS_OF_TANGENT = [
  [0.0, 0.0],
  [0.12435499454676144, -3.1253241424539383e-18],
  [0.24497866312686414, 1.0698755618734451e-17],
  [0.35877067027057225, -2.4623815582638635e-17],
  [0.4636476090008061, 2.2698777452961687e-17],
  [0.5585993153435624, -5.4556305485916264e-18],
  [0.6435011087932844, 1.5834785051444286e-17],
  [0.7188299996216245, -2.1478388444456983e-17],
  [0.7853981633974483, 3.061616997868383e-17],
];
const LARGEST_ANGLE = 2 ** 15; // rad, of `cosineAndSineOfPart`
const LARGEST_REDUCED = 1e15; // rad
// 2 pi in 384 bits.
const TWO_PI = new Big(
  BigInt(
    "0x6487ed5110b4611a62633145c06e0e68948127044533e63a0105df531d89cd9128a5043cc71a026ef7ca8cd9e69d218e",
  ),
  -380,
  384,
);

/**
 * The nearest integer; the even one of two.
 * @param {number} x
 */
export const roundToInteger = (x) => {
  const size = Math.abs(x);
  if (size >= 2 ** 52) return x;
  const rounded = size + 2 ** 52 - 2 ** 52;
  return x < 0 || Object.is(x, -0) ? -rounded : rounded;
};

/**
 * @param {number} x
 * @param {number} rest
 * @returns {[number, number]}
 */
const cosineAndSineNear0 = (x, rest) => {
  const square = x * x;
  let versine = VERSINE[0] * square;
  let series = SINE[0] * square;
  for (let n = 1; n < 8; n += 1) {
    versine = (versine + VERSINE[n]) * square;
    series = (series + SINE[n]) * square;
  }
  return [1 - (versine + x * rest), x + (x * series + rest)];
};

/**
 * Cosine and sine of up to some thousand turns.
 * @param {number} x
 * @returns {[number, number]}
 */
const cosineAndSineOfPart = (x) => {
  const quarters = roundToInteger(x * QUARTERS);
  const part = x - quarters * QUARTER_HIGH;
  const low = quarters * QUARTER_LOW;
  const near = part - low;
  let [c, s] = cosineAndSineNear0(near, part - near - low);
  if (quarters & 1) [c, s] = [s, c];
  return [(quarters + 1) & 2 ? -c : c, quarters & 2 ? -s : s];
};

/**
 * Cosine and sine of an angle in rad; of many turns whole ones are taken off with long numbers.
 * @param {number} angle
 * @returns {[number, number]}
 */
export const cosineAndSine = (angle) => {
  if (Math.abs(angle) <= LARGEST_ANGLE) return cosineAndSineOfPart(angle);
  if (Math.abs(angle) > LARGEST_REDUCED) return [Math.cos(angle), Math.sin(angle)];
  const exact = Big.of(angle, LONG);
  const turns = roundToInteger(exact.over(TWO_PI).number);
  return cosineAndSineOfPart(exact.minus(TWO_PI.times(turns)).number);
};

/**
 * The angle of the point (x, y), from -pi to pi.
 * @param {number} y
 * @param {number} x
 */
export const arcTangent = (y, x) => {
  const [height, width] = [Math.abs(y), Math.abs(x)];
  const [large, small] = height > width ? [height, width] : [width, height];
  const ratio = large > 0 ? small / large : 0;
  const place = roundToInteger(8 * ratio);
  const nearest = place * 0.125;
  const z = (ratio - nearest) / (1 + ratio * nearest);
  const square = z * z;
  let series = ARC_TANGENT[0] * square;
  for (const c of ARC_TANGENT.slice(1)) series = (series + c) * square;
  const [high, low] = EIGHTHS_OF_TANGENT[place];
  let angle = high + (z + z * series + low);
  const isLeft = x < 0 || Object.is(x, -0);
  if (height > width) angle = HALF_PI_HIGH - (isLeft ? -angle : angle) + HALF_PI_LOW;
  else if (isLeft) angle = Math.PI - angle + PI_LOW;
  return y < 0 || Object.is(y, -0) ? -angle : angle;
};

/**
 * sqrt(x^2 + y^2)
 * @param {number} x
 * @param {number} y
 */
export const findLength = (x, y) => {
  const [width, height] = [Math.abs(x), Math.abs(y)];
  const [large, small] = width > height ? [width, height] : [height, width];
  if (large === 0) return 0;
  const ratio = small / large;
  return large * Math.sqrt(1 + ratio * ratio);
};
