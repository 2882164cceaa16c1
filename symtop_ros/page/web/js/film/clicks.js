// The points of a film that were clicked: data that do not change, and those before them.

/** Pixels of the film, from its upper left corner: to the right and down. @typedef {[number, number]} Place */
/**
 * @typedef {{pivot: Place | null, length: readonly Place[], balls: ReadonlyMap<number, Place>}} Clicks
 * the ball by the number of its frame
 */
/** What is clicked. @typedef {"pivot" | "length" | "ball"} Aim */

/** @type {Clicks} */
const NONE = { pivot: null, length: [], balls: new Map() };

/** @param {Clicks} clicks @param {number} frame @param {Place | null} place */
export const setBall = (clicks, frame, place) => {
  const balls = new Map(clicks.balls);
  if (place) balls.set(frame, place);
  else balls.delete(frame);
  return { ...clicks, balls };
};

/** With one click more; the third end of a length begins another one. @param {Clicks} clicks @param {Aim} aim @param {number} frame @param {Place} place */
export const addClick = (clicks, aim, frame, place) => {
  if (aim === "ball") return setBall(clicks, frame, place);
  if (aim === "pivot") return { ...clicks, pivot: place };
  return { ...clicks, length: [...(clicks.length.length === 2 ? [] : clicks.length), place] };
};

/**
 * The clicks that are seen in a frame, each with its aim and how it is moved.
 * @param {Clicks} clicks @param {number} frame
 * @returns {{aim: Aim, place: Place, move: (place: Place) => Clicks}[]}
 */
export const listMarks = (clicks, frame) => {
  const { pivot, length, balls } = clicks;
  const ball = balls.get(frame);
  return [
    ...(pivot
      ? [{ aim: /** @type {Aim} */ ("pivot"), place: pivot, move: movePivot(clicks) }]
      : []),
    ...length.map((place, k) => ({
      aim: /** @type {Aim} */ ("length"),
      place,
      move: moveEnd(clicks, k),
    })),
    ...(ball
      ? [{ aim: /** @type {Aim} */ ("ball"), place: ball, move: moveBall(clicks, frame) }]
      : []),
  ];
};

/** @param {Clicks} clicks */
const movePivot = (clicks) => (/** @type {Place} */ place) => ({ ...clicks, pivot: place });

/** @param {Clicks} clicks @param {number} which */
const moveEnd = (clicks, which) => (/** @type {Place} */ place) => ({
  ...clicks,
  length: clicks.length.map((each, k) => (k === which ? place : each)),
});

/** @param {Clicks} clicks @param {number} frame */
const moveBall = (clicks, frame) => (/** @type {Place} */ place) => setBall(clicks, frame, place);

/** The clicks of now and those before. */
export class History {
  constructor() {
    this.now = NONE;
    /** @type {Clicks[]} */
    this.past = [];
  }

  /** @param {Clicks} next */
  take(next) {
    this.past.push(this.now);
    this.now = next;
  }

  undo() {
    this.now = this.past.pop() ?? this.now;
  }

  clear() {
    this.now = NONE;
    this.past = [];
  }

  get isEmpty() {
    return !this.now.pivot && !this.now.length.length && !this.now.balls.size;
  }
}
