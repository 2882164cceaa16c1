// Light or dark: as chosen, or as the system prefers. Large for a projector.

import { keepChoice } from "./choices.js";
import { find } from "./document.js";

const dark = matchMedia("(prefers-color-scheme: dark)");

const setTheme = () => {
  const choice = find("theme", HTMLSelectElement).value || (dark.matches ? "dark" : "light");
  document.documentElement.dataset.theme = choice;
};

export const followTheme = () => {
  keepChoice("theme", setTheme);
  dark.addEventListener("change", setTheme);
  setTheme();
};

const setSize = () => {
  document.documentElement.dataset.size = find("size", HTMLSelectElement).value;
};

/** Text and lines of a usual size, or for a projector. */
export const followSize = () => {
  keepChoice("size", setSize);
  setSize();
};
