// What the page says beside the headline: refusals, notices, and what is lost.

import { nameError } from "../run/errors.js";
import { find, write } from "./document.js";
import { typesetSymbols } from "../words/typeset.js";
import { phrase } from "../words/wording.js";

/** The field whose text is refused. @type {HTMLInputElement | null} */
let refused = null;

/**
 * A refusal or a notice stands until the next act; an empty one takes it away. It has no words of
 * arrows: what was got may be another page's.
 * @param {string} text @param {boolean} isOfData whose names are shown as they are typed
 */
export const refuse = (text, isOfData = false) => {
  refused = null;
  show("refusal", text, isOfData ? (plain) => [plain] : typesetSymbols);
};

/** Refuse the text of a field. @param {HTMLInputElement} field @param {string} text */
export const refuseField = (field, text) => {
  refuse(text);
  refused = field;
  field.setAttribute("aria-invalid", "true");
};

/** A field has become good: what was said of it no longer holds. @param {HTMLInputElement} field */
export const acceptField = (field) => {
  field.removeAttribute("aria-invalid");
  if (refused === field) refuse("");
};

/** A refusal can be put away. */
export const dismissRefusals = () => {
  find("refusal").addEventListener("click", () => refuse(""));
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || find("refusal").hidden) return;
    refuse("");
    event.preventDefault(); // the key has done its work, and closes no panel
  });
};

/** Errors that have been shown. @type {Set<string>} */
const shown = new Set();

/**
 * A part of the work of every frame: an error costs this part only, and is shown once.
 * @template {any[]} T
 * @param {string} name
 * @param {(...given: T) => void} work
 * @returns {(...given: T) => void}
 */
export const guard =
  (name, work) =>
  (...given) => {
    try {
      work(...given);
    } catch (error) {
      const key = `${name}: ${error}`;
      if (!shown.has(key)) refuse(phrase("page.broken", { part: name, error: nameError(error) }));
      shown.add(key);
    }
  };

/**
 * What is lost, the connection or the picture, until it is back.
 * @param {string | null} text @param {"lost" | "picture-lost"} id
 */
export const showLoss = (text, id = "lost") => show(id, text ?? "");

/** @param {string} id @param {string} text @param {typeof typesetSymbols} [set] */
const show = (id, text, set) => {
  const place = find(id);
  write(place, text, set);
  place.hidden = !text;
};
