// What a tab keeps over a reload: its entry of the browser's history holds the run. A frame of another
// site may have no history; then it lasts as long as the page.

/**
 * The step of the lesson that has started a motion, with its link; the language that was chosen; the run
 * as in run.json, the speed of its top, and whether it runs; what was answered to the question
 * whose answer is seen.
 * @typedef {{begun?: {step: number, link: string}, language?: string,
 *   run?: any | null, speed?: number, isRunning?: boolean,
 *   question?: {answer: string, isSecond: boolean, roots: number[][]} | null}} Memory
 */

/** @type {Memory} */
const memory = { ...history.state };

export const FULL = "symtop-full"; // the event of a browser that has no room

/** Tell the page of an error that says so; a frame without a store is none. @param {unknown} error */
export const tellFull = (error) => {
  const isForbidden = error instanceof DOMException && error.name === "SecurityError";
  if (!isForbidden) dispatchEvent(new Event(FULL));
};

/** @returns {Memory} */
export const recall = () => memory;

/**
 * @param {Memory} changes
 * @param {string} [fragment] of the address
 * @param {boolean} [isNew] a step of its own for the button Back
 */
export const remember = (changes, fragment, isNew = false) => {
  Object.assign(memory, changes);
  try {
    history[isNew ? "pushState" : "replaceState"](memory, "", fragment);
  } catch (error) {
    tellFull(error);
  }
};

const PERIOD = 2000; // ms; browsers allow some hundred changes of the history in half a minute

/** Remember the run of a top from now on. @param {{json: any, speed: number, isRunning: boolean}} top */
export const rememberRun = (top) => {
  let last = "";
  /** The points that were measured: many, of which none changes. @type {unknown} */
  let before;
  const keep = () => {
    const { json: run, speed, isRunning } = top;
    const { points, ...rest } = run;
    const now = JSON.stringify([rest, speed, isRunning]);
    if (now !== last || points !== before) remember({ run, speed, isRunning });
    [last, before] = [now, points];
  };
  setInterval(keep, PERIOD);
  addEventListener("beforeunload", keep);
  document.addEventListener("visibilitychange", keep);
};
