// What the page says beside the headline: refusals, notices, and what is lost.

import { find } from "./document.js";

/**
 * A refusal or a notice stands until the next act; an empty one takes it away.
 * @param {string} text
 */
export const refuse = (text) => show("refusal", text);

/** What is lost, such as a connection, until it is back. @param {string | null} text */
export const showLoss = (text) => show("lost", text ?? "");

/**
 * @param {string} id
 * @param {string} text
 */
const show = (id, text) => {
  const place = find(id);
  place.textContent = text;
  place.hidden = !text;
};
