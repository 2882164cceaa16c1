// The beginning of the page: the kernel, the top, its scene, and the page around it.

import { LAYERS } from "./scene/colors.js";
import { Fitting } from "./fit/client.js";
import { Kernel } from "./physics/kernel.js";
import { LocalTop } from "./run/local.js";
import { NodeTop } from "./run/node.js";
import { turnByKeys } from "./controls/keys.js";
import { find, findAll } from "./controls/document.js";
import { guard, showLoss } from "./controls/notices.js";
import { Page } from "./page.js";
import { chooseLanguage } from "./controls/language.js";
import { NoPicture } from "./scene/painter.js";
import { Scene } from "./scene/scene.js";
import { TraceChart } from "./charts/trace_chart.js";
import { offerSheets } from "./controls/sheets.js";
import { createShoot } from "./scene/shots.js";
import { unpack } from "./packed.js";
import { copyPage, readData } from "./run/files.js";
import { phrase, setTemplates } from "./words/wording.js";

const USUAL = "cusps"; // the scene of a node

/**
 * What the file holds: languages, the texts of each key in all of them, scenes, the lesson and the
 * fields of a run; what it opens as the end of an address does; a run, if one was saved; and the name of
 * a node, if it shows one.
 * @typedef {{languages: string[], texts: {[key: string]: (string | null)[]}, scenes: any[],
 *   lesson: any[], bodies: {[name: string]: import("./physics/kernel.js").Part[]}, run_fields: import("./run/reader.js").Table, opening?: string, run?: any,
 *   node?: string}} Content
 */

/**
 * The texts by languages; a key that a language has not is not there.
 * @param {Content} content @returns {{[language: string]: {[key: string]: string}}}
 */
const listTexts = ({ languages, texts }) => {
  const all = Object.entries(texts);
  const list = (/** @type {number} */ place) =>
    all.flatMap(([key, each]) => (each[place] === null ? [] : [[key, each[place]]]));
  return Object.fromEntries(
    languages.map((name, place) => [name, Object.fromEntries(list(place))]),
  );
};

/**
 * The scene; without WebGL 2 the way of the axle, and why there is no more.
 * @param {import("./run/local.js").LocalTop} top
 */
const openScene = (top) => {
  try {
    const scene = new Scene(top);
    turnByKeys(scene.camera);
    scene.tellLoss = (text) => showLoss(text, "picture-lost");
    return scene;
  } catch (error) {
    if (!(error instanceof NoPicture)) throw error;
    showLoss(error.message, "picture-lost");
    return new TraceChart(top);
  }
};

/** Without the kernel nothing can be computed: the page says so for good, and asks for nothing. @param {string} text */
const close = (text) => {
  showLoss(text);
  for (const id of ["legend", "reason"]) find(id).hidden = true;
  for (const each of findAll("button, input, select, textarea"))
    Object.assign(each, { disabled: true });
};

/** The top whose moments stand for those that no record shows: as for `top_fit --run`. @param {Content} content */
const findUsualTop = ({ scenes }) => {
  const [Ix, Iz, Mgl] = scenes.find(({ name }) => name === USUAL).top;
  return { Ix, Iz, Mgl };
};

/** @param {Promise<ArrayBuffer>} code */
const loadKernel = async (code) => {
  try {
    return await Kernel.load(await code);
  } catch (error) {
    close(phrase("page.no_kernel"));
    console.error(error);
    return null;
  }
};

export const start = async () => {
  const script = document.currentScript;
  script?.remove(); // a page that is saved holds it packed
  const source = copyPage();
  try {
    const { kernel: code, packed, ...own } = readData("top-content");
    const unpacked = unpack(code).arrayBuffer(); // while the texts are
    /** @type {Content} */
    const content = { ...(await unpack(packed).json()), ...own, run: readData("top-run") };
    const texts = listTexts(content);
    const language = chooseLanguage(texts);
    setTemplates(texts[language], language);
    const page = new Page(content);
    const kernel = await loadKernel(unpacked);
    if (!kernel) return;
    const Top = content.node ? NodeTop : LocalTop;
    const top = new Top(kernel, { ...content, layers: LAYERS });
    const fitting = new Fitting(script?.textContent ?? "", await unpacked, findUsualTop(content));
    // For scripts of the page: motions of their own, the run as in run.json, and fits of points.
    const symtop = {
      motion: kernel.motion.bind(kernel),
      run: () => top.json,
      fit: fitting.fit.bind(fitting),
    };
    Object.assign(window, { symtop });
    const scene = openScene(top);
    top.tell = guard("texts", page.receive.bind(page));
    top.draw = guard("scene", scene.draw.bind(scene));
    top.begin = guard("scene", scene.begin.bind(scene));
    top.advance = guard("motion", top.advance.bind(top));
    page.connect(top, source, fitting);
    offerSheets(content.lesson, createShoot(scene, kernel, { ...content, layers: LAYERS }));
    top.open();
  } catch (error) {
    // In English: it may be the texts that are missing.
    close(`the top cannot be shown: ${error instanceof Error ? error.message : error}`);
    console.error(error);
  }
};
