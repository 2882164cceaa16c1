// Impulses of the torques about the line of nodes, as integrals over the height: phi' has a spike where
// the axis passes next to the vertical, which equal steps of time would miss.
//
// With u = u1 + (u2 - u1) sin^2(x) the equation of the height, (du/dt)^2 = beta (u - u1)(u2 - u)(u3 - u),
// is dx/dt = sqrt(R)/2 with R = beta (u3 - u), and x grows all the time. R and phi' are sums of
// products that keep their digits near either pole.

import { findFrameTorques } from "../physics/formulas.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */
/** @typedef {[gravity: number, coriolis: number, centrifugal: number]} Impulses in N m s */

// Nodes and weights of Kronrod's rule with 15 points, and of Gauss' with 7 that it contains.
const NODES = [
  0.9914553711208126, 0.9491079123427585, 0.8648644233597691, 0.7415311855993943,
  0.5860872354676911, 0.4058451513773972, 0.2077849550078985, 0.0,
];
const KRONROD = [
  0.02293532201052922, 0.06309209262997854, 0.1047900103222502, 0.1406532597155259,
  0.1690047266392679, 0.1903505780647854, 0.2044329400752989, 0.2094821410847278,
];
const GAUSS = [
  0, 0.1294849661688697, 0, 0.2797053914892767, 0, 0.3818300505051189, 0, 0.4179591836734694,
];
const BOUND = 1e-9; // of the integral of the sizes, to which the impulses are found
const DEEPEST = 40; // halvings of a part
const FLAT = 1e-10; // of u2 - u1: less is regular precession
const QUARTER = Math.PI / 2;
const NEAR = 0.1; // of x to a turning point
const SLIP = 1e-6; // rad of x, which next to a turning point is the square root of rounding

/** sin^2(a/2) - sin^2(b/2) as a product. @param {number} a @param {number} b */
const subtractSquares = (a, b) => Math.sin((a + b) / 2) * Math.sin((a - b) / 2);

/** The motion of a course over x. @param {Course} course */
const followHeight = ({ top: { Ix, Iz, Mgl }, start, motion }) => {
  const [least, most] = motion.turning_angles; // theta of u2 and of u1
  const [x, y, spin] = start.omega;
  const [gx, gy] = start.vertical;
  const { theta } = start.angles;
  const [a, beta] = [(Iz / Ix) * spin, (2 * Mgl) / Ix];
  // sin^2 of half the angle is (1 - u)/2, and cos^2 is (1 + u)/2
  const [below, above] = [least, theta].map((each) => Math.sin(each / 2) ** 2);
  const [rise, fall] = [most, theta].map((each) => Math.cos(each / 2) ** 2);
  const along = x * gx + y * gy; // sin^2(theta) phi'
  const range = subtractSquares(most, least); // (u2 - u1)/2
  const [fromUpper, fromLower] = [along - 2 * a * above, along + 2 * a * fall]; // b - a, b + a
  const [near, far] = [Math.sin(most / 2) ** 2, Math.cos(least / 2) ** 2];
  const isUpper = Mgl > 0;
  const product = isUpper ? 4 * below * near : 4 * rise * far;
  const squared = x * x + y * y;
  // Of an axis that passes the pole nothing is left of the product.
  const rest = product
    ? (isUpper ? fromUpper : fromLower) ** 2 / product
    : squared + a * a + beta * (2 * (near + below - above) - 1 - (isUpper ? 1 : -1));
  /** R at a tilt. @param {number} tilt */
  const findRoot = (tilt) =>
    rest + 2 * beta * (isUpper ? Math.sin(tilt / 2) ** 2 : -(Math.cos(tilt / 2) ** 2));
  return {
    range,
    /** The torques at x, times dt/dx. @param {number} at @returns {Impulses} */
    integrate(at) {
      const [sine, cosine] = [Math.sin(at), Math.cos(at)];
      const [down, up] = [below + range * cosine * cosine, rise + range * sine * sine];
      const height = up - down;
      const tilt = 2 * Math.sqrt(down * up); // sin(theta)
      const turning = down < up ? fromUpper + 2 * a * down : fromLower - 2 * a * up;
      const rate = turning / (4 * down * up);
      const root = rest + beta * (isUpper ? 2 * down : -2 * up);
      const duration = 2 / Math.sqrt(root);
      const coriolis = -Iz * (spin - rate * height) * rate * tilt;
      const centrifugal = (Ix - Iz) * (rate * rate) * tilt * height;
      return [Mgl * tilt * duration, coriolis * duration, centrifugal * duration];
    },
    /**
     * x of a state, in the first half turn. Next to a turning point the angle has half of its digits,
     * and the small one of sin(x) and cos(x) comes from du/dt = (u2 - u1) sin(x) cos(x) sqrt(R).
     * @param {State} state
     */
    place({ angles: { theta: tilt }, rates }) {
      const lower = Math.sqrt(Math.max(subtractSquares(most, tilt), 0));
      const upper = Math.sqrt(Math.max(subtractSquares(tilt, least), 0));
      const large = Math.max(lower, upper) / Math.hypot(lower, upper);
      const speed = Math.abs(Math.sin(tilt) * rates.theta);
      const small = speed / (2 * range * Math.sqrt(findRoot(tilt)) * large);
      const isNear = Math.min(lower, upper) < NEAR * Math.max(lower, upper);
      const known = lower < upper ? Math.atan2(small, large) : Math.atan2(large, small);
      const found = isNear ? known : Math.atan2(lower, upper);
      return rates.theta > 0 ? Math.PI - found : found;
    },
  };
};

/**
 * Gauss' and Kronrod's rules in a part, which is halved until they agree.
 * @param {(at: number) => Impulses} at @param {number} begin @param {number} end
 * @param {number[]} sizes the integrals of the sizes so far @param {number} depth
 * @returns {Impulses}
 */
const addUp = (at, begin, end, sizes, depth = 0) => {
  const [middle, half] = [(begin + end) / 2, (end - begin) / 2];
  /** @type {Impulses} */
  const fine = [0, 0, 0];
  const [coarse, size] = [
    [0, 0, 0],
    [0, 0, 0],
  ];
  NODES.forEach((node, n) => {
    for (const side of node ? [-1, 1] : [1])
      at(middle + side * half * node).forEach((value, k) => {
        fine[k] += half * KRONROD[n] * value;
        coarse[k] += half * GAUSS[n] * value;
        size[k] += Math.abs(half) * KRONROD[n] * Math.abs(value);
      });
  });
  const agree = fine.every((value, k) => {
    const whole = Math.max(sizes[k], size[k]);
    return Math.abs(value - coarse[k]) <= BOUND * whole;
  });
  if (agree || depth === DEEPEST) {
    size.forEach((each, k) => {
      sizes[k] += each;
    });
    return fine;
  }
  const first = addUp(at, begin, middle, sizes, depth + 1);
  const second = addUp(at, middle, end, sizes, depth + 1);
  return /** @type {Impulses} */ (first.map((each, k) => each + second[k]));
};

/**
 * The impulses since the start of a motion under gravity alone, to 1e-9 of the largest, for a time of
 * at most half a nutation.
 * @param {Course} course @param {State} state at that time @param {number} passed s
 * @returns {Impulses}
 */
export const findImpulses = (course, state, passed) => {
  const height = followHeight(course);
  const begin = height.place(course.start);
  if (height.range < FLAT) {
    const { angles, rates } = course.start;
    const torques = findFrameTorques(course.top, angles.theta, rates.phi, rates.psi);
    const { gravity, coriolis, centrifugal } = torques;
    return [gravity * passed, coriolis * passed, centrifugal * passed];
  }
  if (!passed) return [0, 0, 0];
  // In half a nutation x grows by less than half a turn, after which the same place is passed again.
  let end = height.place(state);
  while (end < begin - SLIP) end += Math.PI;
  while (end > begin + Math.PI - SLIP) end -= Math.PI;
  // At a turning point, where phi' may have its spike, the way is cut.
  const first = QUARTER * Math.floor(begin / QUARTER + 1);
  const cuts = [first, first + QUARTER].filter((each) => each < end);
  const parts = [begin, ...cuts, Math.max(begin, end)];
  const sizes = [0, 0, 0];
  return parts.slice(1).reduce(
    (sum, each, k) => {
      const part = addUp(height.integrate, parts[k], each, sizes);
      return /** @type {Impulses} */ (sum.map((one, n) => one + part[n]));
    },
    /** @type {Impulses} */ ([0, 0, 0]),
  );
};
