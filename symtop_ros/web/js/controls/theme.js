// Light or dark: as chosen, or as the system prefers.

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
