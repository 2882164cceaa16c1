// The scene as a picture for a report: with its sentence, its labels and its legend, as on the page.

import { find, findAll } from "../controls/document.js";

const EDGE = 3; // px between a label and its frame
const LINE = 26; // px of the sentence

/** @param {string} name of a style of the page */
const readStyle = (name) => getComputedStyle(document.documentElement).getPropertyValue(name);

/**
 * A text with its frame or without, where an element stands.
 * @param {CanvasRenderingContext2D} context
 * @param {HTMLElement} element
 * @param {DOMRect} scene
 * @param {boolean} isFramed
 */
const drawText = (context, element, scene, isFramed) => {
  const box = element.getBoundingClientRect();
  const style = getComputedStyle(element);
  const [x, y] = [box.left - scene.left, box.top - scene.top + LINE];
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  if (isFramed) {
    context.fillStyle = readStyle("--back");
    context.strokeStyle = style.borderColor;
    context.fillRect(x, y, box.width, box.height);
    context.strokeRect(x, y, box.width, box.height);
  }
  context.fillStyle = style.color;
  context.fillText(element.textContent ?? "", x + EDGE, y + box.height / 2, box.width);
};

/** @returns {HTMLCanvasElement} */
export const drawPicture = () => {
  const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
  const scene = canvas.getBoundingClientRect();
  const ratio = canvas.width / scene.width;
  const height = Math.round((scene.height + LINE) * ratio);
  const picture = Object.assign(document.createElement("canvas"), { width: canvas.width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (picture.getContext("2d"));
  context.fillStyle = readStyle("--back");
  context.fillRect(0, 0, picture.width, picture.height);
  context.drawImage(canvas, 0, LINE * ratio);
  context.scale(ratio, ratio);
  context.lineWidth = 2;
  context.textBaseline = "middle";
  context.fillStyle = readStyle("--text");
  context.font = `bold 15px ${getComputedStyle(document.body).fontFamily}`;
  context.fillText(find("headline").textContent ?? "", EDGE, LINE / 2, scene.width - 2 * EDGE);
  for (const label of findAll(".label:not([hidden])")) drawText(context, label, scene, true);
  for (const entry of findAll("#legend li:not([hidden])")) {
    const [drawn] = findAll("[aria-pressed=true]", entry);
    if (drawn) drawText(context, drawn, scene, false);
  }
  return picture;
};
