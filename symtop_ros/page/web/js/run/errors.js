// Errors in words. A refusal is a RangeError with its sentence; any other error is a bug.

import { phrase } from "../words/wording.js";

/** @param {unknown} error */
export const nameError = (error) => {
  const text = error instanceof Error ? error.message : String(error);
  if (error instanceof RangeError) return text;
  console.error(error);
  return phrase("page.bug", { text });
};
