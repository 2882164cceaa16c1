// A run as files: saved from the page, and opened by dropping it there.

import { find, make } from "../controls/document.js";
import { refuse } from "../controls/notices.js";
import { findSort } from "../film/sorts.js";
import { NANO } from "../physics/course.js";
import { drawPicture } from "../scene/picture.js";
import { chooseWindow } from "../words/facts.js";
import { phrase } from "../words/wording.js";

/** @import { LocalTop } from "./local.js" */

const SHARE = 200; // of a window: rows of a table in it
const MOST = 20_000; // rows between two events; a longer time has them farther apart
const RUN = "top-run"; // element of a page that holds its run
const KEPT = 10_000; // ms until the browser has begun to save

/** Whether the page is in a sandboxed frame: whether it may save files is not to be seen there. */
const isSandboxed = () =>
  window.parent !== window && window.origin === "null" && location.protocol !== "file:";

/** @param {string} href @param {string} name */
const download = (href, name) => {
  make("a", { href, download: name }).click();
  if (isSandboxed()) refuse(phrase("page.frame", { name }));
};

/** @param {string} name @param {string} type @param {string} text */
export const save = (name, type, text) => {
  const url = URL.createObjectURL(new Blob([text], { type }));
  download(url, name);
  setTimeout(() => URL.revokeObjectURL(url), KEPT);
};

/** The page as it was opened: nothing has been written into it yet. */
export const copyPage = () => /** @type {Element} */ (document.documentElement.cloneNode(true));

/** The data that an element of the page holds; its text if they cannot be read. @param {string} id */
export const readData = (id) => {
  const text = find(id).textContent ?? "";
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
};

/**
 * A page with a run in it. Data are no script, and no end of an element is among them.
 * @param {Element} source @param {string} run
 */
const writePage = (source, run) => {
  const place = /** @type {Element} */ (source.querySelector(`#${RUN}`));
  source.setAttribute("lang", document.documentElement.lang);
  source.setAttribute("data-own", "");
  place.textContent = run.replaceAll("<", "\\u003c");
  return `<!doctype html>\n${source.outerHTML}`;
};

/** The text of a run: that of a run.json, or that in a page. @param {string} text */
const findRun = (text) => {
  if (!text.trimStart().startsWith("<")) return text;
  return new DOMParser().parseFromString(text, "text/html").getElementById(RUN)?.textContent ?? "";
};

/** The series of a run as a table of comma-separated values. @param {LocalTop} top */
const writeSeries = ({ run: { moments }, time: now }) => {
  const names = ["phi", "theta", "psi"];
  const heads = [
    ...names.map((each) => `${each} (rad)`),
    ...names.map((each) => `${each}_dot (rad/s)`),
  ];
  const lines = [["time (s)", ...heads].join(",")];
  moments.forEach(({ time: begin, course }, k) => {
    const end = moments[k + 1]?.time ?? now;
    const wanted = Math.round((chooseWindow(course.free) / SHARE) * NANO);
    const step = Math.max(wanted, Math.ceil((end - begin) / MOST), 1);
    for (let time = begin; time < end; time += step) {
      const { angles, rates } = course.at(time - begin);
      const numbers = [angles.phi, angles.theta, angles.psi, rates.phi, rates.theta, rates.psi];
      lines.push([time / NANO, ...numbers].join(","));
    }
  });
  return `${lines.join("\n")}\n`;
};

/** @param {LocalTop} top @param {Element} source the page as it was opened */
export const offerFiles = (top, source) => {
  const writeRun = () => JSON.stringify(top.json);
  /** @type {{[id: string]: () => void}} */
  const ways = {
    "save-page": () => save("top.html", "text/html", writePage(source, writeRun())),
    "save-run": () => save("run.json", "application/json", writeRun()),
    "save-series": () => save("top.csv", "text/csv", writeSeries(top)),
    "save-picture": () => download(drawPicture().toDataURL("image/png"), "top.png"),
  };
  for (const [id, way] of Object.entries(ways)) find(id).addEventListener("click", way);
};

/** @param {File} file @param {(run: any) => void} load @param {((file: File) => void) | null} measure */
const openOne = async (file, load, measure) => {
  if (!measure || (await findSort(file)) === "run") open(file, load);
  else measure(file);
};

/** @param {File} file a run.json or a saved page @param {(run: any) => void} load */
const open = async (file, load) => {
  const text = await file.text();
  let run = null;
  try {
    run = JSON.parse(findRun(text));
  } catch {
    refuse(phrase("page.not_a_run", { name: file.name }));
    return;
  }
  load(run);
};

/**
 * Open what is dropped: a run here, a film or a table of points as a measurement.
 * @param {(run: any) => void} load @param {((file: File) => void) | null} measure null: nothing else
 */
export const openDropped = (load, measure) => {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) openOne(file, load, measure);
  });
};
