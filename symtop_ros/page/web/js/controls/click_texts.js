// What the panel says of the clicks in a film, and which of its buttons can be pressed.

import { find, say } from "./document.js";
import { phrase } from "../words/wording.js";

/** @import { Clicking } from "./clicking.js" */
/** @import { Film } from "../film/film.js" */

/** @param {{[id: string]: boolean}} ids of buttons, and whether each is disabled */
const disable = (ids) => {
  for (const [id, disabled] of Object.entries(ids)) Object.assign(find(id), { disabled });
};

/** What is to be clicked now. @param {Clicking} clicking */
const writeNext = ({ clicks, aim, isReady }) => {
  const isHalf = aim === "length" && clicks.length.length === 1;
  const kind = aim === "ball" && !isReady ? "rate" : isHalf ? "length_end" : aim;
  say("click-next", phrase("measure.next", { kind }));
  find("length-fields").hidden = aim !== "length" && !clicks.length.length;
};

/** Which frames are clicked, of those that are to be. @param {Clicking} clicking @param {Film} film */
const writePlan = ({ clicks, planned, step }, { times }) => {
  const [from, to] = [times[planned[0]], times[planned[planned.length - 1]]];
  const counts = { count: planned.length, done: clicks.balls.size };
  say("plan", phrase("measure.plan", { ...counts, from, to, step }));
};

/** @param {Clicking} clicking @param {Film} film */
const enableButtons = ({ clicks, planned, answer, isFollowing, history }, { place }) => {
  const isFound = answer?.kind === "found";
  disable({
    "take-ball": !isFound,
    "follow-ball": !isFound && !isFollowing,
    "undo-click": !history.past.length,
    "remove-click": !clicks.balls.has(place),
    "frame-back": !planned.some((each) => each < place),
    "frame-next": !planned.some((each) => each > place),
  });
};

/** The frame that is shown, beside the film and at its slider. @param {Film} film */
const writeFrame = ({ place, times }) => {
  const line = find("film-line", HTMLInputElement);
  const last = times.length - 1;
  Object.assign(line, { max: last, value: place });
  line.style.setProperty("--part", `${(100 * place) / Math.max(last, 1)}%`);
  const record = { frame: place + 1, frames: times.length, time: times[place] };
  say("film-clock", phrase("measure.clock", record));
  line.setAttribute("aria-valuetext", phrase("measure.clock", record));
};

/** @param {Clicking} clicking @param {Film} film */
export const writeClicking = (clicking, film) => {
  const { answer, isFollowing } = clicking;
  writeNext(clicking);
  writePlan(clicking, film);
  say("ball-found", answer ? phrase("measure.found", { kind: answer.kind }) : "");
  say("follow-ball", phrase(isFollowing ? "measure.follow_end" : "measure.follow"));
  enableButtons(clicking, film);
  writeFrame(film);
};
