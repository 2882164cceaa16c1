// The scene as a picture for a report: with its sentence, and its labels and words as on the page.

import { find, findAll } from "../controls/document.js";
import { arrange } from "./labels.js";

const EDGE = 3; // px between a text and its frame
const LINE = 26; // px of the sentence
const [WIDTH, LARGE] = [300, 1]; // px of a small picture whose labels are as large as on the page
const WIDE = 1.3; // its shape
const LABELS = ".label:not([hidden])";
const SHOWN = `${LABELS}, #legend [aria-pressed=true], #legend li:not([hidden]) > i`;

/**
 * A text where its element stands, with the ground around its letters, or a mark of the legend.
 * @param {CanvasRenderingContext2D} context @param {HTMLElement} element @param {DOMRect} scene
 */
const drawText = (context, element, scene) => {
  const { left, top, width, height } = element.getBoundingClientRect();
  const style = getComputedStyle(element);
  const [x, y] = [left - scene.left, top - scene.top];
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  context.fillStyle = style.backgroundColor;
  context.strokeStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(x, y, width, height);
  context.fillStyle = style.color;
  const named = element.tagName === "I" ? element.parentElement : element;
  const begin = element.tagName === "I" ? width + EDGE : EDGE;
  const text = named?.textContent ?? "";
  context.strokeText(text, x + begin, y + height / 2);
  context.fillText(text, x + begin, y + height / 2);
};

/**
 * The scene with texts of the page where they stand, below a strip of some height.
 * @param {string} texts that are drawn: a selector
 * @param {number} strip px
 */
const compose = (texts, strip) => {
  const canvas = find("picture", HTMLCanvasElement);
  const scene = canvas.getBoundingClientRect();
  const ratio = canvas.width / scene.width;
  const height = Math.round((scene.height + strip) * ratio);
  const picture = Object.assign(document.createElement("canvas"), { width: canvas.width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (picture.getContext("2d"));
  context.fillStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(0, 0, picture.width, picture.height);
  context.drawImage(canvas, 0, strip * ratio);
  context.scale(ratio, ratio);
  context.translate(0, strip);
  Object.assign(context, { lineWidth: 4, lineJoin: "round", textBaseline: "middle" });
  for (const each of texts ? findAll(texts) : []) drawText(context, each, scene);
  return { picture, context, scene, ratio };
};

/** The scene with its labels. */
export const drawScene = () => compose(LABELS, 0).picture;

/**
 * The labels of the scene as large as they are on paper, inside the picture and apart: where they stand in
 * a picture that begins so far from the left of the scene, and is so large. @param {DOMRect} scene
 * @param {number} begin px @param {{width: number, height: number}} size px @param {number} larger times
 */
const placeLabels = (scene, begin, size, larger) => {
  const boxes = findAll(LABELS).map((element) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const [x, y] = [left + width / 2 - scene.left, top + height / 2 - scene.top];
    const from = { x, y };
    return { element, from, x: x - begin, y, width: larger * width, height: larger * height };
  });
  arrange(boxes, size);
  return boxes;
};

/** The middle of the scene, with labels that can be read where it is small. */
export const drawSmall = () => {
  const { picture: whole, context, scene, ratio } = compose("", 0);
  const { height } = whole;
  const width = Math.min(whole.width, Math.round(WIDE * height));
  const begin = (whole.width - width) / 2;
  const size = { width: width / ratio, height: height / ratio };
  const widest = Math.max(...findAll(LABELS).map(({ offsetWidth }) => offsetWidth), 1);
  const larger = Math.min((LARGE * size.width) / WIDTH, size.width / widest);
  for (const { element, from, x, y } of placeLabels(scene, begin / ratio, size, larger)) {
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.translate(x + begin / ratio, y);
    context.scale(larger, larger);
    context.translate(-from.x, -from.y);
    drawText(context, element, scene);
  }
  const picture = Object.assign(document.createElement("canvas"), { width, height });
  picture.getContext("2d")?.drawImage(whole, -begin, 0);
  return picture;
};

/** With its sentence, and the words of the legend. */
export const drawPicture = () => {
  const { picture, context, scene } = compose(SHOWN, LINE);
  const { color, fontFamily } = getComputedStyle(document.body);
  context.fillStyle = color;
  context.font = `bold 15px ${fontFamily}`;
  context.fillText(find("headline").textContent ?? "", EDGE, -LINE / 2, scene.width - 2 * EDGE);
  return picture;
};
