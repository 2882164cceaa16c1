// The language of the page.

import { keep, read } from "./choices.js";
import { find, make } from "./document.js";
import { recall, remember } from "../run/memory.js";

/** The language that the address asks for. */
const findAsked = () => new URLSearchParams(location.hash.slice(1)).get("lang");

/** The languages that are wished for, the first one most. */
const listWishes = () => {
  const { lang, dataset } = document.documentElement;
  const own = "own" in dataset ? lang : null; // of a page that was saved or written in it
  return [findAsked(), recall().language, own, read("language"), ...navigator.languages];
};

/** The address without its language. */
const dropAsked = () => {
  const rest = location.hash.slice(1).split("&");
  return `#${rest.filter((pair) => !pair.startsWith("lang=")).join("&")}`;
};

/**
 * Find the language of the page, and offer the others: the page is loaded again for them, with its run.
 * @param {{[language: string]: {[key: string]: string}}} texts
 */
export const chooseLanguage = (texts) => {
  const tags = listWishes().map((each) => each?.slice(0, 2).toLowerCase() ?? "");
  const chosen = tags.find((tag) => Object.hasOwn(texts, tag)) ?? "en";
  document.documentElement.lang = chosen;
  const list = find("language", HTMLSelectElement);
  for (const [value, { language }] of Object.entries(texts))
    list.append(make("option", { value, textContent: language, lang: value }));
  list.value = chosen;
  list.addEventListener("change", () => {
    keep("language", list.value);
    remember({ language: list.value }, dropAsked());
    location.reload();
  });
  addEventListener("hashchange", () => {
    const asked = findAsked();
    if (asked && asked !== chosen && Object.hasOwn(texts, asked)) location.reload();
  });
  return chosen;
};
