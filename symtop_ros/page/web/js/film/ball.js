// Where the ball is in a frame: the middle of what has its colour. It is looked for next to where the
// frames that were clicked say that it will be.

/** @import { Place } from "./clicks.js" */
/**
 * What a ball looks like: its colour, its area in pixels, how far its colour is from that of the ground,
 * and how much longer than wide it is.
 * @typedef {{colour: number[], area: number, ground: number, stretch: number}} Look
 */
/** Pixels of a part of a frame, from a corner at x, y. @typedef {{x: number, y: number, data: ImageData}} Part */
/** @typedef {{kind: "found", place: Place} | {kind: "none" | "second" | "blurred" | "edge"}} Answer */

const PATCH = 1; // px around a click, whose middle colour is that of the ball
const WIDE = 40; // px around a click, in which its look is read
const LIKE = 0.5; // part of a pixel that the ball covers, from which on it is like the ball
const FAINT = 0.15; // below it, noise of the ground
const FAINTEST = 24; // of 441, the distance of black and white: a ball that is hardly seen
const SECOND = 0.4; // of the area of the ball: another thing that is like it
const SMALLER = 0.6; // of the area, and of the coverage of its middle
const LARGER = 1.7;
const STRETCHED = 1.6; // times longer than it was
const REACH = [12, 160]; // px around the place where it is expected
const AROUND = 3; // radii of the ball, the same

/** @param {CanvasRenderingContext2D} picture @param {Place} place @param {number} reach px @returns {Part} */
export const cut = (picture, [x, y], reach) => {
  const { width, height } = picture.canvas;
  const clip = (/** @type {number} */ value, /** @type {number} */ most) =>
    Math.min(Math.max(Math.round(value), 0), most);
  const [left, top] = [clip(x - reach, width - 1), clip(y - reach, height - 1)];
  const [right, bottom] = [clip(x + reach, width), clip(y + reach, height)];
  const data = picture.getImageData(
    left,
    top,
    Math.max(right - left, 1),
    Math.max(bottom - top, 1),
  );
  return { x: left, y: top, data };
};

/** @param {number[]} numbers */
const findMiddle = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1] ?? 0;

/** The middle colour of pixels. @param {Part} part @param {number[]} pixels by their numbers */
const mix = ({ data: { data } }, pixels) =>
  [0, 1, 2].map((k) => findMiddle(pixels.map((pixel) => data[4 * pixel + k])));

/** How far each pixel is from a colour. @param {Part} part @param {number[]} colour */
const measure = ({ data: { data, width, height } }, [red, green, blue]) =>
  Float64Array.from({ length: width * height }, (_, k) =>
    Math.hypot(data[4 * k] - red, data[4 * k + 1] - green, data[4 * k + 2] - blue),
  );

/** The pixels of the edge of a part. @param {Part} part */
const listEdge = ({ data: { width, height } }) =>
  Array.from({ length: width * height }, (_, k) => k).filter((k) => {
    const [x, y] = [k % width, Math.floor(k / width)];
    return !x || !y || x === width - 1 || y === height - 1;
  });

/** The pixels within a patch around a place. @param {Part} part @param {Place} place */
const listPatch = ({ x, y, data: { width, height } }, place) => {
  const [column, row] = [Math.floor(place[0]) - x, Math.floor(place[1]) - y];
  const steps = Array.from({ length: 2 * PATCH + 1 }, (_, k) => k - PATCH);
  return steps
    .flatMap((down) => steps.map((right) => [column + right, row + down]))
    .filter(([i, j]) => i >= 0 && j >= 0 && i < width && j < height)
    .map(([i, j]) => j * width + i);
};

/** What part of each pixel the ball covers. @param {Float64Array} far @param {number} ground */
const cover = (far, ground) => far.map((each) => Math.max(1 - each / ground, 0));

/**
 * Things that hang together and are like the ball, each by its pixels.
 * @param {Float64Array} covered @param {number} width
 */
const listThings = (covered, width) => {
  const seen = new Uint8Array(covered.length);
  const things = [];
  for (let first = 0; first < covered.length; first += 1) {
    if (seen[first] || covered[first] < LIKE) continue;
    const thing = [first];
    seen[first] = 1;
    for (const pixel of thing)
      for (const next of listNeighbours(pixel, width, covered.length)) {
        if (seen[next] || covered[next] < LIKE) continue;
        seen[next] = 1;
        thing.push(next);
      }
    things.push(thing);
  }
  return things;
};

/** @param {number} pixel @param {number} width @param {number} count */
const listNeighbours = (pixel, width, count) =>
  [
    pixel % width ? pixel - 1 : -1,
    (pixel + 1) % width ? pixel + 1 : -1,
    pixel - width,
    pixel + width,
  ].filter((each) => each >= 0 && each < count);

/** A thing with the soft edge around it. @param {number[]} thing @param {number} width @param {number} count */
const widen = (thing, width, count) => {
  const ring = (/** @type {number[]} */ each) =>
    each.flatMap((pixel) => listNeighbours(pixel, width, count));
  const once = ring(thing);
  return [...new Set([...thing, ...once, ...ring(once)])];
};

/**
 * Area, middle and stretch of a thing, each pixel with the part that the ball covers.
 * @param {Part} part @param {number[]} thing @param {Float64Array} covered
 */
const weigh = ({ x, y, data: { width } }, thing, covered) => {
  const pixels = widen(thing, width, covered.length).filter((each) => covered[each] > FAINT);
  let [area, right, down] = [0, 0, 0];
  for (const pixel of pixels) {
    area += covered[pixel];
    right += covered[pixel] * ((pixel % width) + 0.5);
    down += covered[pixel] * (Math.floor(pixel / width) + 0.5);
  }
  const [u, v] = [right / area, down / area];
  let [xx, xy, yy] = [0, 0, 0];
  for (const pixel of pixels) {
    const [a, b] = [(pixel % width) + 0.5 - u, Math.floor(pixel / width) + 0.5 - v];
    xx += (covered[pixel] * a * a) / area;
    xy += (covered[pixel] * a * b) / area;
    yy += (covered[pixel] * b * b) / area;
  }
  const [sum, root] = [xx + yy, Math.hypot(xx - yy, 2 * xy)];
  const stretch = Math.sqrt((sum + root + 0.02) / (sum - root + 0.02));
  return { area, stretch, place: /** @type {Place} */ ([x + u, y + v]) };
};

/** What the ball looks like where it was clicked; null if it is not told from the ground. @param {CanvasRenderingContext2D} picture @param {Place} place @returns {Look | null} */
export const findLook = (picture, place) => {
  const part = cut(picture, place, WIDE);
  const colour = mix(part, listPatch(part, place));
  const far = measure(part, colour);
  const ground = findMiddle(listEdge(part).map((each) => far[each]));
  if (ground < FAINTEST) return null;
  const covered = cover(far, ground);
  const clicked = new Set(listPatch(part, place));
  const things = listThings(covered, part.data.width);
  const thing = things.find((each) => each.some((pixel) => clicked.has(pixel)));
  if (!thing) return null;
  const { area, stretch } = weigh(part, thing, covered);
  return { colour, ground, area, stretch };
};

/** The middle of several looks. @param {Look[]} looks @returns {Look} */
export const joinLooks = (looks) => ({
  colour: [0, 1, 2].map((k) => findMiddle(looks.map(({ colour }) => colour[k]))),
  area: findMiddle(looks.map(({ area }) => area)),
  ground: findMiddle(looks.map(({ ground }) => ground)),
  stretch: findMiddle(looks.map(({ stretch }) => stretch)),
});

/**
 * Where the ball is expected: on the curve through the nearest clicks, of which three are a parabola.
 * @param {ReadonlyMap<number, Place>} balls @param {number[]} times @param {number} frame
 * @returns {{place: Place, moved: number} | null} and how far it is from the nearest one, in px
 */
export const predict = (balls, times, frame) => {
  const far = (/** @type {number} */ each) => Math.abs(times[each] - times[frame]);
  const near = [...balls.keys()].sort((a, b) => far(a) - far(b)).slice(0, 3);
  if (!near.length) return null;
  const along = (/** @type {0 | 1} */ which) =>
    near.reduce((sum, k) => {
      const weights = near
        .filter((each) => each !== k)
        .map((each) => (times[frame] - times[each]) / (times[k] - times[each]));
      const value = /** @type {Place} */ (balls.get(k))[which];
      return sum + weights.reduce((product, each) => product * each, value);
    }, 0);
  const nearest = /** @type {Place} */ (balls.get(near[0]));
  const [x, y] = [along(0), along(1)];
  return { place: [x, y], moved: Math.hypot(x - nearest[0], y - nearest[1]) };
};

/**
 * The ball in a frame, or why it is not surely there.
 * @param {CanvasRenderingContext2D} picture @param {Look} look
 * @param {{place: Place, moved: number}} expected @returns {Answer}
 */
export const findBall = (picture, look, { place, moved }) => {
  const radius = Math.sqrt(look.area / Math.PI);
  const reach = Math.min(Math.max(AROUND * radius + moved / 2, REACH[0]), REACH[1]);
  const { width, height } = picture.canvas;
  if (place[0] < 0 || place[1] < 0 || place[0] > width || place[1] > height)
    return { kind: "none" };
  const part = cut(picture, place, reach);
  const covered = cover(measure(part, look.colour), look.ground);
  const things = listThings(covered, part.data.width)
    .map((pixels) => ({ pixels, ...weigh(part, pixels, covered) }))
    .sort((a, b) => b.area - a.area);
  return judge(part, look, covered, things);
};

/**
 * What is like the ball in its own middle is one; a disc of wood is like a red ball, but nowhere fully.
 * @param {Part} part @param {Look} look @param {Float64Array} covered
 * @param {{pixels: number[], area: number, stretch: number, place: Place}[]} things the largest first
 * @returns {Answer}
 */
const judge = (part, look, covered, things) => {
  const isFull = (/** @type {number[]} */ pixels) =>
    pixels.some((each) => covered[each] >= SMALLER);
  const [ball, other] = things.filter(({ pixels }) => isFull(pixels));
  if (!ball) return { kind: things.some(({ area }) => area >= 1) ? "blurred" : "none" };
  if (other && other.area > SECOND * look.area) return { kind: "second" };
  const edge = new Set(listEdge(part));
  if (ball.pixels.some((each) => edge.has(each))) return { kind: "edge" };
  const isBlurred = ball.stretch > STRETCHED * look.stretch;
  if (isBlurred || ball.area < SMALLER * look.area || ball.area > LARGER * look.area)
    return { kind: "blurred" };
  return { kind: "found", place: ball.place };
};
