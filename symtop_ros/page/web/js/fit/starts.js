// Starts of the search, without a guess of the camera.
//
// Without perspective a picture of the axis is linear in it, and so are the points of an axis that is
// turned about the vertical. So this linear map is the least squares for each motion (variable
// projection, Golub and Pereyra 1973), and five numbers are left: Mgl/Ix, p_psi/Ix, and the tilt and its
// rates at the start; by the azimuth phi is zero, and by mirror images Mgl and p_psi are positive. As in
// truth/fit/camera_starts.py motions of many shapes are scaled to the frequencies of the record, and the
// best of them are improved.

import { dot, multiplyPairs, solve, transpose } from "./linear.js";
import { minimise } from "./least_squares.js";
import { compose, point } from "./many.js";
import { Model } from "./model.js";

/** @import { Many } from "./many.js" */
/** @import { Record } from "./record.js" */
/** @typedef {{model: Model, x: number[]}} Start */

const SHAPES = 250; // motions whose nutation is scaled to each frequency
const RATES = 20; // frequencies from the slowest to the fastest, besides those of the spectrum
const PEAKS = 6; // of a spectrum
const PAD = 8; // by which a spectrum is finer
const [IMPROVED, STEPS] = [2, 20]; // motions of a frequency that are improved, and how often
const KEPT = 16;
const SAME = 0.02; // of the sizes of Mgl/Ix and p_psi/Ix
const ROWS = 120; // of a part, at which motions are compared
const DELTA = 1e-6; // of differences, in rad or of a rate
const RIDGE = 1e-10; // of the squares of a column: two columns may be one, as without nutation
const [SLOWEST, FASTEST] = [0.1, 30]; // p_psi/sqrt(Ix Mgl)
const [SMALL, LARGE] = [0.05, 3]; // rates of the tilt and of the azimuth
const WIDEST = 0.97; // cosine of the tilt
const BLACKMAN_HARRIS = [0.35875, -0.48829, 0.14128, -0.01168];
// Fractions of their multiples fill a cube of four dimensions evenly (Roberts 2018): powers of the
// root of g^5 = g + 1.
const ROOT = 1.1673039782614187;
const BEST_ENDS = 1e-6;

/** Numbers from a to b with equal ratios. @param {number} a @param {number} b @param {number} count */
const space = (a, b, count) =>
  Array.from({ length: count }, (_, k) => a * (b / a) ** (k / (count - 1)));

/** A motion of Mgl/Ix, p_psi/Ix, theta, theta' and phi' sin(theta), with phi = 0. @param {number[]} y */
const throwTop = ([weight, p, theta, tilting, turning]) => ({
  weight,
  q: point(0, theta),
  omega: [tilting, turning, p],
});

/** The sizes of these numbers: rates are those of the motion. @param {number[]} y */
const findSizes = ([weight, p, , tilting, turning]) => {
  const rate = Math.sqrt(Math.abs(weight)) + Math.max(...[p, tilting, turning].map(Math.abs));
  return [Math.max(Math.abs(weight), 0.01 * rate ** 2), rate, 1, rate, rate];
};

/** Motions for Mgl/Ix = 1, with the angular frequencies of their nutation. @param {Many} many */
const drawShapes = (many) => {
  const momenta = space(SLOWEST, FASTEST, SHAPES);
  const shapes = momenta.map((p, k) => {
    const [a, b, c, d] = [1, 2, 3, 4].map((power) => ((k + 1) / ROOT ** power) % 1);
    const size = SMALL * (LARGE / SMALL) ** b * Math.sqrt(-2 * Math.log(1 - d));
    const [tilting, turning] = [size * Math.cos(2 * Math.PI * c), size * Math.sin(2 * Math.PI * c)];
    const y = [1, p, Math.acos(WIDEST * (2 * a - 1)), tilting, turning];
    return { y, own: (2 * Math.PI) / many.findRates(throwTop(y)).nutation_period };
  });
  return shapes.filter(({ own }) => own > 0 && own < Infinity);
};

/** @param {number[]} y @param {number} faster */
const hasten = ([weight, p, theta, tilting, turning], faster) => [
  weight * faster ** 2,
  p * faster,
  theta,
  tilting * faster,
  turning * faster,
];

/** The points of a part of a record, and the linear maps that show motions best. */
class Pictures {
  /** @param {Many} many @param {Record} part */
  constructor(many, part) {
    const step = Math.max((part.count - 1) / (ROWS - 1), 1);
    const rows = Array.from({ length: ROWS }, (_, k) => Math.floor(k * step));
    const places = rows.filter((each) => each < part.count);
    this.many = many;
    this.times = Float64Array.from(places, (k) => part.times[k]);
    this.points = transpose(places.map((k) => part.values[k]));
    this.hasPivot = part.kind === "axis"; // at zero
  }

  /** What the best linear map leaves of each motion, and the map; null of one that is none. @param {number[][]} all */
  compareAll(all) {
    const seen = this.many.findAxes(all.map(throwTop), this.times);
    return seen.map((axes) => (axes ? this.compare(axes) : null));
  }

  /** @param {Float64Array} axes */
  compare(axes) {
    const columns = [0, 1, 2].map((k) => this.times.map((_, row) => axes[3 * row + k]));
    if (!this.hasPivot) columns.push(this.times.map(() => 1));
    const normal = multiplyPairs(columns);
    const size = normal.reduce((sum, row, k) => sum + row[k], 0);
    normal.forEach((row, k) => {
      row[k] += RIDGE * size;
    });
    const rights = this.points.map((each) => columns.map((column) => dot(column, each)));
    const maps = solve(normal, rights) ?? rights.map((each) => each.map(() => 0));
    const left = new Float64Array(maps.length * this.times.length);
    maps.forEach((map, k) => {
      for (let row = 0; row < this.times.length; row += 1) {
        let shown = -this.points[k][row];
        for (let j = 0; j < map.length; j += 1) shown += map[j] * columns[j][row];
        left[k * this.times.length + row] = shown;
      }
    });
    return { maps, left, cost: dot(left, left) };
  }

  /** @param {number[]} y */
  improve(y) {
    const find = (/** @type {number[]} */ x) => this.compareAll([x])[0]?.left ?? this.lost;
    const derive = (/** @type {number[]} */ x) => {
      const steps = findSizes(x).map((each) => DELTA * each);
      const moved = steps.map((step, k) => x.map((each, j) => (j === k ? each + step : each)));
      const [own, ...others] = this.compareAll([x, ...moved]).map(
        (each) => each?.left ?? this.lost,
      );
      return others.map((each, k) => each.map((left, row) => (left - own[row]) / steps[k]));
    };
    const problem = { find, derive, clip: (/** @type {number[]} */ x) => x, isSoft: false };
    return minimise(problem, y, STEPS, BEST_ENDS);
  }

  get lost() {
    return new Float64Array(this.points.length * this.times.length).fill(Number.NaN);
  }
}

export class Starts {
  /** @param {Many} many */
  constructor(many) {
    this.many = many;
    this.shapes = drawShapes(many);
  }

  /**
   * The motions, with their maps, that show a part of a record best.
   * @param {Record} part @param {(part: number) => void} report is called with the part that is done
   * @returns {Start[]}
   */
  list(part, report) {
    const pictures = new Pictures(this.many, part);
    const rates = listRates(part);
    const best = rates
      .flatMap((rate, k) => {
        report(k / rates.length);
        return this.choose(pictures, rate).map((y) => pictures.improve(y));
      })
      .filter(({ cost }) => Number.isFinite(cost))
      .sort((a, b) => a.cost - b.cost);
    return chooseDifferent(best.map(({ x }) => x)).flatMap((y) => {
      const seen = pictures.compareAll([y])[0];
      return seen ? [this.fill(part, y, seen.maps)] : [];
    });
  }

  /** The best shapes whose nutation has an angular frequency. @param {Pictures} pictures @param {number} rate */
  choose(pictures, rate) {
    const all = this.shapes.map(({ y, own }) => hasten(y, rate / own));
    return pictures
      .compareAll(all)
      .map((each, k) => ({ y: all[k], cost: each?.cost ?? Infinity }))
      .sort((a, b) => a.cost - b.cost)
      .slice(0, IMPROVED)
      .map(({ y }) => y);
  }

  /** @param {Record} part @param {number[]} y @param {number[][]} maps @returns {Start} */
  fill(part, y, maps) {
    const { azimuth, seen, own } = part.kind === "axis" ? readTurn(maps, y) : readView(maps, y);
    const [weight, p, theta, wx, wy] = own;
    const half = azimuth / 2;
    const reference = compose([Math.cos(half), 0, 0, Math.sin(half)], point(0, theta));
    const model = new Model(this.many, part, reference);
    return { model, x: model.fill({ "Mgl/Ix": weight, "p_psi/Ix": p, wx, wy, ...seen }) };
  }
}

/** The first motions of some in order, each minimum once. @param {number[][]} all */
const chooseDifferent = (all) => {
  /** @type {number[][]} */
  const kept = [];
  for (const y of all) {
    const sizes = findSizes(y);
    const isNew = kept.every((each) =>
      [0, 1].some((k) => Math.abs(each[k] - y[k]) > SAME * sizes[k]),
    );
    if (isNew) kept.push(y);
    if (kept.length === KEPT) break;
  }
  return kept;
};

/**
 * The azimuth and the numbers of the camera nearest to a linear map: its polar part, with two rows at
 * right angles. @param {number[][]} maps rows for u and v @param {number[]} own
 */
const readView = ([first, second], own) => {
  const [a, b, c] = [
    dot(first.slice(0, 3), first),
    dot(first.slice(0, 3), second),
    dot(second.slice(0, 3), second),
  ];
  // The root of a symmetric matrix of two rows is (A + d)/t, with d^2 = det A and t^2 = tr A + 2 d.
  const d = Math.sqrt(Math.max(a * c - b * b, 0));
  const t = Math.sqrt(a + c + 2 * d) + 1e-300;
  const [rows, size] = [[0, 1, 2], d * t + 1e-300];
  const up = rows.map((k) => ((c + d) * first[k] - b * second[k]) / size);
  const high = rows.map((k) => ((a + d) * second[k] - b * first[k]) / size);
  const roll = Math.atan2(-up[2], high[2]);
  const [cos, sin] = [Math.cos(roll), Math.sin(roll)];
  const right = rows.map((k) => cos * up[k] + sin * high[k]);
  const rising = rows.map((k) => cos * high[k] - sin * up[k]);
  const azimuth = Math.atan2(-right[1], right[0]);
  const above = rising[0] * Math.sin(azimuth) + rising[1] * Math.cos(azimuth);
  const seen = {
    roll,
    elevation: Math.atan2(above, rising[2]),
    log_scale: Math.log(t / 2 + 1e-300), // t is the sum of both sizes
    u: first[3],
    v: second[3],
  };
  return { azimuth, seen, own };
};

/**
 * The azimuth of an axis, and the motion of which it is one: the other end if z was turned over, and the
 * mirror image if the rest of the map is a reflection. @param {number[][]} maps @param {number[]} own
 */
const readTurn = ([first, second, third], own) => {
  let [weight, p, theta, tilting, turning] = own;
  const isUpright = third[2] >= 0;
  if (!isUpright) [weight, p, theta, tilting] = [-weight, -p, Math.PI - theta, -tilting];
  let [a, b, c, d] = [first[0], first[1], second[0], second[1]];
  if (a * d - b * c < 0) [a, c, p, turning] = [-a, -c, -p, -turning];
  return { azimuth: Math.atan2(c - b, a + d), seen: {}, own: [weight, p, theta, tilting, turning] };
};

/**
 * Angular frequencies of a nutation: from slow to fast, and of the spectrum. A nutation may be a hundred
 * times smaller than the precession, whose sidelobes are lower by this window than noise is.
 * @param {Record} part
 */
const listRates = (part) => {
  const { step, seconds } = part;
  const [slowest, fastest] = [Math.PI / seconds, Math.PI / step];
  const peaks = findPeaks(part);
  const both = peaks.flatMap((one, k) => peaks.slice(k + 1).map((other) => Math.abs(one - other)));
  const all = [...space(slowest, fastest, RATES), ...peaks, ...both];
  return [...new Set(all)].filter((each) => each >= slowest && each <= 1.2 * fastest);
};

/** The highest peaks of the spectrum of all columns. @param {Record} part */
const findPeaks = (part) => {
  const count = Math.max(Math.ceil(part.seconds / part.step), 2);
  const even = Array.from({ length: count }, (_, k) => k * part.step);
  const waves = transpose(part.values).map((each) => prepare(part.times, each, even));
  const power = Array.from({ length: (PAD * count) / 2 + 1 }, (_, k) =>
    waves.reduce((sum, each) => sum + transform(each, (2 * Math.PI * k) / (PAD * count)), 0),
  );
  const tops = power.flatMap((each, k) =>
    k > 0 && each > power[k - 1] && each > power[k + 1] ? [k] : [],
  );
  const best = tops.sort((a, b) => power[b] - power[a]).slice(0, PEAKS);
  return best.map((k) => (2 * Math.PI * k) / (PAD * count * part.step));
};

/** Values at equal steps, about their mean, under a window. @param {Float64Array} times @param {number[]} column @param {number[]} even */
const prepare = (times, column, even) => {
  let k = 0;
  const values = even.map((t) => {
    while (k < times.length - 2 && times[k + 1] < t) k += 1;
    const part = (t - times[k]) / (times[k + 1] - times[k]);
    return column[k] + part * (column[k + 1] - column[k]);
  });
  const mean = values.reduce((sum, each) => sum + each, 0) / values.length;
  return values.map((each, place) => {
    const phase = (2 * Math.PI * place) / (values.length - 1);
    const window = BLACKMAN_HARRIS.reduce((sum, part, n) => sum + part * Math.cos(n * phase), 0);
    return (each - mean) * window;
  });
};

/** The power of a wave at a phase from row to row (Goertzel). @param {number[]} wave @param {number} phase */
const transform = (wave, phase) => {
  const twice = 2 * Math.cos(phase);
  let [last, before] = [0, 0];
  for (const each of wave) [last, before] = [each + twice * last - before, last];
  return last * last + before * before - twice * last * before;
};
