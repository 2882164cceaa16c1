// The tabs of the controls, as the authoring practices of ARIA describe them.

import { find, findAll, make } from "./document.js";
import { phrase } from "../words/wording.js";

/** @type {{[key: string]: number}} */
const STEPS = { ArrowRight: 1, ArrowLeft: -1 };

/** Open a panel, or none. @param {HTMLElement | null} chosen */
const choose = (chosen) => {
  findAll(".tab").forEach((panel, k) => {
    const isChosen = panel === chosen;
    panel.hidden = !isChosen;
    const tab = find(`tab-${panel.id}`);
    tab.setAttribute("aria-selected", String(isChosen));
    tab.tabIndex = isChosen || (!chosen && k === 0) ? 0 : -1;
  });
  document.body.classList.toggle("has-panel", chosen !== null);
  document.body.classList.toggle("in-lesson", chosen?.id === "lesson");
};

/** @param {HTMLElement} panel @param {KeyboardEvent} event */
const move = (panel, event) => {
  const step = STEPS[event.key];
  if (!step) return;
  const panels = findAll(".tab");
  const next = panels[(panels.indexOf(panel) + step + panels.length) % panels.length];
  choose(next);
  find(`tab-${next.id}`).focus();
};

/** @param {HTMLElement} panel */
const addTab = (panel) => {
  panel.setAttribute("role", "tabpanel");
  panel.setAttribute("aria-labelledby", `tab-${panel.id}`);
  const tab = make("button", {
    id: `tab-${panel.id}`,
    textContent: phrase(`tab.${panel.id}`),
    role: "tab",
    "aria-controls": panel.id,
  });
  tab.addEventListener("click", () => choose(panel.hidden ? panel : null));
  tab.addEventListener("keydown", (event) => move(panel, event));
  find("tabs").append(tab);
};

export const addTabs = () => {
  const panels = findAll(".tab");
  panels.forEach(addTab);
  choose(null);
};
