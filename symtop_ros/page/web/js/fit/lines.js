// Whether what is left swings at a frequency of the motion.
//
// Twin of truth/residuals/lines.py, whose text has the sources, at given frequencies; top_fit also looks
// at all others.

import { dot } from "./linear.js";

/** @import { Fit } from "./refine.js" */

const TAPERS = 7;
const WIDTH = (TAPERS + 1) / 2; // half of their band, in steps of frequency 1/T
const FEWEST = 64; // rows
const CHANCE = 1e-3; // of a false alarm in a record
const FINER = 8; // frequencies for each step
const NEAR = Array.from({ length: FINER + 1 }, (_, k) => k / FINER - 0.5);
const TINY = 1e-300;

/** Sines at times, made orthogonal by Gram and Schmidt. @param {number[]} times @param {number} step */
const makeTapers = (times, step) => {
  const whole = times[times.length - 1] - times[0] + 2 * step;
  /** @type {number[][]} */
  const found = [];
  for (let order = 1; order <= TAPERS; order += 1) {
    let taper = times.map((t) => Math.sin((order * Math.PI * (t - times[0] + step)) / whole));
    for (const other of found) {
      const part = dot(taper, other);
      taper = taper.map((each, row) => each - part * other[row]);
    }
    const size = Math.sqrt(dot(taper, taper));
    found.push(taper.map((each) => each / size));
  }
  return found;
};

/**
 * The chance of such a line in noise: F with 2 and 2 (K - 1) degrees of freedom.
 * @param {number[][]} tapered @param {number[]} sums of the tapers @param {number[]} phases
 */
const findChance = (tapered, sums, phases) => {
  const weight = dot(sums, sums);
  const parts = [Math.cos, Math.sin].map((wave) => {
    const waves = phases.map(wave);
    return tapered.map((each) => dot(each, waves));
  });
  const lines = parts.map((each) => dot(each, sums) / weight);
  const noise = parts.flatMap((each, k) => each.map((one, n) => (one - lines[k] * sums[n]) ** 2));
  const ratio =
    (weight * dot(lines, lines)) /
    Math.max(
      dot(
        noise,
        noise.map(() => 1),
      ),
      TINY,
    );
  return (1 + ratio) ** (1 - TAPERS);
};

/** The frequencies of a motion in Hz: once and twice the nutation and the precession. @param {Fit} fit */
const listFrequencies = ({ model, x }) => {
  try {
    const { nutation_period, mean_precession_rate } = model.many.findRates(model.read(x));
    const own = [1 / nutation_period, Math.abs(mean_precession_rate) / (2 * Math.PI)];
    return own.flatMap((each) => [each, 2 * each]).filter(Number.isFinite);
  } catch {
    return [];
  }
};

/** The kept rows of a column less their mean. @param {Fit} fit @param {number} column */
const takeColumn = ({ model, noise, residuals }, column) => {
  const rows = noise.kept.map((row) => residuals[row * model.record.width + column]);
  const mean = rows.reduce((sum, each) => sum + each, 0) / rows.length;
  return rows.map((each) => each - mean);
};

/** Whether what is left swings with the motion, by more than errors of rounding do. @param {Fit} fit */
export const isSwinging = (fit) => {
  const { noise, model } = fit;
  const times = noise.kept.map((row) => model.record.times[row]);
  if (times.length < FEWEST) return false;
  const steps = times.slice(1).map((t, k) => t - times[k]);
  const step = steps.sort((a, b) => a - b)[steps.length >> 1];
  const resolution = 1 / (times[times.length - 1] - times[0] + step);
  const fold = (/** @type {number} */ f) => Math.abs(f - Math.round(f * step) / step);
  const [low, high] = [WIDTH * resolution, 0.5 / step - WIDTH * resolution];
  const tried = listFrequencies(fit)
    .map(fold)
    .filter((f) => f >= low && f <= high);
  const tapers = makeTapers(times, step);
  const sums = tapers.map((each) => each.reduce((sum, one) => sum + one, 0));
  const most = CHANCE / 2 / (tried.length * NEAR.length * model.record.width);
  return noise.sigma.some((_, column) => {
    const rows = takeColumn(fit, column);
    const size = Math.sqrt(dot(rows, rows) / rows.length);
    if (size <= model.record.rounding[column]) return false;
    const tapered = tapers.map((each) => each.map((one, row) => one * rows[row]));
    return tried.some((f) =>
      NEAR.some((part) => {
        const rate = 2 * Math.PI * (f + part * resolution);
        const phases = times.map((t) => rate * (t - times[0]));
        return findChance(tapered, sums, phases) < most;
      }),
    );
  });
};
