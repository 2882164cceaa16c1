// The result of a fit in the panel Measure: two sentences, a table, what cannot be known, and what is left.

import { drawResiduals, nameChart } from "../charts/residuals_chart.js";
import {
  COLUMNS,
  listNumbers,
  listUnknown,
  writeAssumed,
  writeLimits,
  writeMeanings,
  writeShown,
  writeVerdict,
} from "../words/fit.js";
import { phrase } from "../words/wording.js";
import { find, make, write } from "./document.js";

/** @import { Fitted } from "../fit/answer.js" */

/** The fit that is shown. @type {{fitted: Fitted, command: string} | null} */
let shown = null;

/** @param {"p" | "h2" | "li" | "th" | "td"} name @param {string} text @param {{[name: string]: string}} properties */
const createText = (name, text, properties = {}) => {
  const element = make(name, properties);
  write(element, text);
  return element;
};

/** @param {Fitted} fitted */
const createTable = (fitted) => {
  const heads = ["fitted.number", "fitted.value"].map((key) =>
    createText("th", phrase(key), { scope: "col" }),
  );
  const rows = listNumbers(fitted).map(([name, text]) =>
    make("tr", {}, createText("th", name, { scope: "row" }), createText("td", text)),
  );
  const head = make("thead", {}, make("tr", {}, ...heads));
  return make("table", { id: "fitted-numbers" }, head, make("tbody", {}, ...rows));
};

/** @param {Fitted} fitted */
const listCharts = ({ kind }) =>
  COLUMNS[kind].map((column) => {
    const place = make("div", { id: nameChart(column) });
    place.innerHTML = '<svg role="img"></svg>';
    return place;
  });

/** What this search leaves out, with the command that does not. @param {Fitted} fitted @param {string} command */
const listLimits = (fitted, command) => {
  const text = writeLimits(fitted);
  if (!text) return [];
  const code = make("code", {}, command);
  return [createText("p", text, { id: "fitted-limits" }), make("p", {}, code)];
};

/** @param {Fitted} fitted @param {string} command */
const createAll = (fitted, command) => {
  const unknown = listUnknown(fitted).map((each) => createText("li", each));
  const assumed = writeAssumed(fitted);
  return [
    createText("p", writeShown(fitted), { id: "fitted-shown" }),
    createText("p", writeVerdict(fitted), { id: "fitted-verdict" }),
    ...listLimits(fitted, command),
    createTable(fitted),
    createText("p", writeMeanings(fitted), { id: "fitted-meanings", className: "dim" }),
    createText("h2", phrase("fitted.unknown_title")),
    make("ul", { id: "fitted-unknown" }, ...unknown),
    ...(assumed ? [createText("p", assumed, { id: "fitted-assumed" })] : []),
    createText("h2", phrase("fitted.residuals_title")),
    ...listCharts(fitted),
    createText("p", phrase("fitted.residuals_legend"), { className: "dim" }),
  ];
};

/**
 * Show the result of a fit from now on.
 * @param {Fitted} fitted @param {string} command of `top_fit` for the same record
 */
export const showFitted = (fitted, command) => {
  shown = { fitted, command };
  find("fitted").replaceChildren(...createAll(fitted, command));
  drawResiduals(fitted);
};

/** Another measurement has no result yet. */
export const hideFitted = () => {
  shown = null;
  find("fitted").replaceChildren();
};

/** Show it in the unit that was chosen. */
export const showFittedUnit = () => {
  if (shown) showFitted(shown.fitted, shown.command);
};
