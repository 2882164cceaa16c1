// What the browser keeps when the page is closed, where it keeps anything: a frame may have no store.

import { tellFull } from "../run/memory.js";
import { find } from "./document.js";

/** @param {string} id */
export const read = (id) => {
  try {
    return localStorage.getItem(`symtop.${id}`);
  } catch {
    return null;
  }
};

/** Without a store the choice is that of this page alone. @param {string} id @param {string} value */
export const keep = (id, value) => {
  try {
    localStorage.setItem(`symtop.${id}`, value);
  } catch (error) {
    tellFull(error);
  }
};

/** Choose a value of a list that keeps it. @param {string} id @param {string} value */
export const choose = (id, value) => {
  const list = find(id, HTMLSelectElement);
  list.value = value;
  list.dispatchEvent(new Event("change"));
};

/** Keep what is chosen in a list, and take over what was. @param {string} id @param {() => void} follow */
export const keepChoice = (id, follow = () => {}) => {
  const list = find(id, HTMLSelectElement);
  const kept = read(id);
  // A choice of another version of the page may be none of this list.
  if ([...list.options].some(({ value }) => value === kept)) list.value = kept ?? "";
  list.addEventListener("change", () => {
    keep(id, list.value);
    follow();
  });
  follow();
};

/** Light or dark, as chosen or as the system prefers; large for a projector. */
export const followLooks = () => {
  const { dataset } = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const setTheme = () => {
    dataset.theme = find("theme", HTMLSelectElement).value || (dark.matches ? "dark" : "light");
  };
  keepChoice("theme", setTheme);
  dark.addEventListener("change", setTheme);
  keepChoice("size", () => {
    dataset.size = find("size", HTMLSelectElement).value;
  });
};
