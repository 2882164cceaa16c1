// Elements of the page's document.

import { typeset } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

/**
 * The element of an id; another kind of element is a mistake in the markup.
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} [kind]
 * @returns {T}
 */
export const find = (id, kind) => {
  const element = document.getElementById(id);
  if (!(element instanceof (kind ?? HTMLElement))) throw new Error(`the page has no ${id}`);
  return /** @type {T} */ (element);
};

/**
 * All elements that a selector matches, inside an element or in the page.
 * @param {string} selector @param {ParentNode} inside @returns {HTMLElement[]}
 */
export const findAll = (selector, inside = document) =>
  [...inside.querySelectorAll(selector)].map((each) => /** @type {HTMLElement} */ (each));

/**
 * A new element with properties, attributes (of names with a hyphen, and role) and children.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} name
 * @param {{[name: string]: any}} properties
 * @param {(Node | string)[]} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export const make = (name, properties = {}, ...children) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "role" || key.includes("-")) element.setAttribute(key, value);
    else Object.assign(element, { [key]: value });
  }
  element.append(...children);
  return element;
};

/**
 * Write a text into an element, with its symbols as formulas; one that is there already is not
 * announced again. The text itself stays with the element.
 * @param {HTMLElement} element @param {string} text @param {typeof typeset} set its parts
 */
export const write = (element, text, set = typeset) => {
  if (element.dataset.text === text) return;
  element.dataset.text = text;
  element.replaceChildren(...set(text));
};

/** Do something when a slider is let go. @param {HTMLInputElement} slider @param {() => void} act */
export const whenReleased = (slider, act) => {
  for (const end of ["change", "pointerup", "blur"]) slider.addEventListener(end, act);
};

/** @type {{[key: string]: number}} */
const STEPS = {
  ArrowRight: 1,
  ArrowUp: 1,
  ArrowLeft: -1,
  ArrowDown: -1,
  PageUp: 10,
  PageDown: -10,
};

/**
 * Keys move a slider by steps. With step="any" a browser has none of its own: Firefox jumps to the ends.
 * @param {HTMLInputElement} slider @param {(steps: number) => void} move
 */
export const stepByKeys = (slider, move) => {
  slider.addEventListener("keydown", (event) => {
    const steps = STEPS[event.key];
    if (!steps || event.shiftKey || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    move(steps);
  });
};

/** Keys move a slider by hundredths of its length. @param {HTMLInputElement} slider */
export const moveByKeys = (slider) => {
  stepByKeys(slider, (steps) => {
    const [low, high] = [Number(slider.min), Number(slider.max)];
    slider.value = String(Number(slider.value) + (steps * (high - low)) / 100);
    for (const name of ["input", "change"]) slider.dispatchEvent(new Event(name));
  });
};

/** @param {string} id @param {string} text */
export const say = (id, text) => write(find(id), text);

/** Write the texts of the markup, which names their keys: of elements, and of attributes. */
export const writeTexts = () => {
  document.title = phrase("page.title");
  for (const element of findAll("[data-say]")) write(element, phrase(element.dataset.say ?? ""));
  for (const element of findAll("[data-label]"))
    element.ariaLabel = phrase(element.dataset.label ?? "");
  for (const element of findAll("[data-title]"))
    element.title = phrase(element.dataset.title ?? "");
};
