// The lesson on paper: a worksheet with room to write, and the teacher's with answers and pictures.

import { makeTable, nameAct, readPredictions } from "./lesson.js";
import { find, make, write } from "./document.js";
import { isKnown, phrase } from "../words/wording.js";

/** @import { Step } from "./lesson.js" */
/** @typedef {"worksheet" | "teacher"} Kind */
/** A picture of what follows requests. @typedef {(shot: import("../scene/shots.js").Shot) => Element} Shoot */

const LINES = 2; // to write on

/** @param {string} text @param {keyof HTMLElementTagNameMap} tag */
const say = (text, tag = "p") => {
  const element = make(tag);
  write(element, text);
  return element;
};

/**
 * A text of the step behind its name, if the step has it: its paragraphs, between which a page may end.
 * @param {string} part @param {string} text
 */
const name = (part, text) =>
  text ? `${phrase(`sheet.${part}`)}: ${text}`.split("\n\n").map((each) => say(each)) : [];

/** @param {number} count */
const rule = (count) => Array.from({ length: count }, () => make("div", { className: "line" }));

/** @param {Step} step @param {string} part */
const read = (step, part) => {
  const key = `lesson.${step.name}.${part}`;
  return isKnown(key) ? phrase(key) : "";
};

/** What was predicted in this browser, or room for it. @param {number} number of the step */
const writePrediction = (number) => {
  const text = readPredictions()[number];
  return text ? [make("p", { className: "given", textContent: text })] : rule(LINES);
};

/** @param {Step} step */
const writeActs = (step) => {
  const buttons = step.acts.map((_, k) => read(step, `act_${k + 1}`)).join(phrase("sheet.then"));
  return [
    ...name("compute", read(step, "compute")),
    ...name("press", buttons),
    ...name("observe", read(step, "look")),
  ];
};

/** @param {Step} step */
const writeRoom = (step) => [
  say(`${phrase("sheet.saw")}:`),
  ...rule(read(step, "compute") ? 2 * LINES : LINES),
  ...name("question", read(step, "question")),
  ...rule(LINES),
];

/** @param {Step} step */
const writeAnswers = (step) => [
  ...name("explain", read(step, "seen")),
  ...makeTable(step),
  ...name("question", read(step, "question")),
  ...name("answer", read(step, "answer")),
  ...name("article", read(step, "source")),
];

/** The last start of a step, and what is done after it. @param {Step} step */
const nameShot = ({ acts, scene, layers }) => ({
  messages: acts.slice(acts.findLastIndex(({ start }) => start)).map((act) => nameAct(act, scene)),
  layers,
});

/** @param {Step} step @param {number} number @param {Kind} kind @param {Shoot} shoot */
const writeStep = (step, number, kind, shoot) => {
  const isTeachers = kind === "teacher";
  return make(
    "section",
    {},
    say(`${number}. ${read(step, "title")}`, "h2"),
    ...(isTeachers ? [shoot(nameShot(step))] : []),
    ...name("predict", read(step, "predict")),
    ...(isTeachers ? [] : writePrediction(number)),
    ...writeActs(step),
    ...(isTeachers ? writeAnswers(step) : writeRoom(step)),
  );
};

/** @param {Step[]} steps @param {Kind} kind @param {Shoot} shoot */
const fill = (steps, kind, shoot) => {
  const head = [say(`${phrase("sheet.title")} (${phrase(`sheet.${kind}`)})`, "h1")];
  if (kind === "worksheet") head.push(make("p", { className: "who" }, phrase("sheet.who")));
  head.push(say(phrase("sheet.introduction")));
  find("sheets").replaceChildren(
    ...head,
    ...steps.map((step, k) => writeStep(step, k + 1, kind, shoot)),
  );
};

/** The buttons that print them. @param {Step[]} steps @param {Shoot} shoot */
export const offerSheets = (steps, shoot) => {
  for (const kind of /** @type {Kind[]} */ (["worksheet", "teacher"])) {
    find(`print-${kind}`).addEventListener("click", () => {
      fill(steps, kind, shoot);
      document.body.dataset.sheet = kind;
      print();
    });
  }
  addEventListener("afterprint", () => {
    delete document.body.dataset.sheet;
    find("sheets").replaceChildren();
  });
};
