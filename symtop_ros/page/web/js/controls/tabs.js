// The tabs of the controls, as the authoring practices of ARIA describe them.

import { find, findAll } from "./document.js";

/** @type {{[key: string]: number}} */
const STEPS = { ArrowRight: 1, ArrowLeft: -1 };

/** @param {HTMLElement} tab */
const findPanel = (tab) => find(tab.getAttribute("aria-controls") ?? "");

/** Open the panel of a tab, or none. @param {HTMLElement | null} chosen */
const choose = (chosen) => {
  findAll("[role=tab]").forEach((tab, k) => {
    const isChosen = tab === chosen;
    findPanel(tab).hidden = !isChosen;
    tab.setAttribute("aria-selected", String(isChosen));
    tab.tabIndex = isChosen || (!chosen && k === 0) ? 0 : -1;
  });
  document.body.classList.toggle("has-panel", chosen !== null);
  document.body.classList.toggle("in-lesson", chosen?.id === "tab-lesson");
};

/** A panel that opens is seen from its beginning, wherever its column was scrolled to. */
const bring = () => {
  for (const id of ["rest", "controls"]) find(id).scrollTop = 0;
  find("controls").scrollIntoView({ block: "nearest" });
};

/** Escape closes the panel that is open, unless it has ended something else; the focus returns to its tab. */
const closeByKey = () => {
  document.addEventListener("keydown", (event) => {
    const [open] = findAll("[role=tab][aria-selected=true]");
    if (event.key !== "Escape" || event.defaultPrevented || event.isComposing || !open) return;
    choose(null);
    open.focus();
  });
};

/** Open the panel of a tab. @param {string} name */
export const openTab = (name) => choose(find(`tab-${name}`));

export const offerTabs = () => {
  const tabs = findAll("[role=tab]");
  tabs.forEach((tab) => {
    tab.addEventListener("click", () => {
      const isOpening = findPanel(tab).hidden;
      choose(isOpening ? tab : null);
      if (isOpening) bring();
    });
    tab.addEventListener("keydown", ({ key }) => {
      if (!STEPS[key]) return;
      const shown = tabs.filter(({ hidden }) => !hidden);
      const next = shown[(shown.indexOf(tab) + STEPS[key] + shown.length) % shown.length];
      choose(next);
      bring();
      next.focus();
    });
  });
  closeByKey();
  choose(null);
};
