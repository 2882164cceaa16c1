// The scene as a picture for a report: with its sentence, and its labels and words as on the page.

import { find, findAll } from "../controls/document.js";

const EDGE = 3; // px between a text and its frame
const LINE = 26; // px of the sentence
const SHOWN = ".label:not([hidden]), #legend [aria-pressed=true], #legend li:not([hidden]) > i";

/**
 * A text where its element stands, with the frame of a label, or a mark of the legend.
 * @param {CanvasRenderingContext2D} context @param {HTMLElement} element @param {DOMRect} scene
 */
const drawText = (context, element, scene) => {
  const { left, top, width, height } = element.getBoundingClientRect();
  const style = getComputedStyle(element);
  const [x, y] = [left - scene.left, top - scene.top + LINE];
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  context.fillStyle = style.backgroundColor;
  context.strokeStyle = style.borderColor;
  context.fillRect(x, y, width, height);
  if (style.borderTopStyle !== "none") context.strokeRect(x, y, width, height);
  context.fillStyle = style.color;
  const named = element.tagName === "I" ? element.parentElement : element;
  const begin = element.tagName === "I" ? width + EDGE : EDGE;
  context.fillText(named?.textContent ?? "", x + begin, y + height / 2);
};

/** @returns {HTMLCanvasElement} */
export const drawPicture = () => {
  const canvas = find("picture", HTMLCanvasElement);
  const scene = canvas.getBoundingClientRect();
  const ratio = canvas.width / scene.width;
  const height = Math.round((scene.height + LINE) * ratio);
  const picture = Object.assign(document.createElement("canvas"), { width: canvas.width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (picture.getContext("2d"));
  const { backgroundColor, color, fontFamily } = getComputedStyle(document.body);
  context.fillStyle = backgroundColor;
  context.fillRect(0, 0, picture.width, picture.height);
  context.drawImage(canvas, 0, LINE * ratio);
  context.scale(ratio, ratio);
  Object.assign(context, { lineWidth: 2, textBaseline: "middle", fillStyle: color });
  context.font = `bold 15px ${fontFamily}`;
  context.fillText(find("headline").textContent ?? "", EDGE, LINE / 2, scene.width - 2 * EDGE);
  for (const each of findAll(SHOWN)) drawText(context, each, scene);
  return picture;
};
