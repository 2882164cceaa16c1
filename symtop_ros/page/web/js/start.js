// The beginning of the page: the kernel, the top, its scene, and the page around it.

import { LAYERS } from "./scene/colors.js";
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
import { copyPage, readData } from "./run/files.js";
import { phrase, setTemplates } from "./words/wording.js";

/**
 * What the file holds: languages, the texts of each key in all of them, scenes, the lesson and the
 * fields of a run; what it opens as the end of an address does; a run, if one was saved; and the name of
 * a node, if it shows one.
 * @typedef {{languages: string[], texts: {[key: string]: (string | null)[]}, scenes: any[],
 *   lesson: any[], bodies: {[name: string]: import("./physics/kernel.js").Part[]}, run_fields: import("./run/reader.js").Table, opening?: string, run?: any,
 *   node?: string}} Content
 */

const LETTERS =
  "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"; // as join.py

/** Bytes: five letters are four of them, and fewer at the end. @param {string} text base 85 */
const decode = (text) => {
  const values = new Map([...LETTERS].map((letter, k) => [letter, k]));
  const view = new DataView(new ArrayBuffer(4 * Math.ceil(text.length / 5)));
  for (let k = 0; k < text.length; k += 5) {
    let sum = 0;
    for (let j = k; j < k + 5; j += 1) sum = 85 * sum + (values.get(text[j] ?? "~") ?? 0);
    view.setUint32((4 * k) / 5, sum);
  }
  return view.buffer.slice(0, Math.floor((4 * text.length) / 5));
};

/** What is packed by gzip. @param {string} text base 85 */
const unpack = (text) => {
  const packed = new Blob([decode(text)]).stream();
  return new Response(packed.pipeThrough(new DecompressionStream("gzip")));
};

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
    // For scripts of the page: motions of their own, and the run as in run.json.
    const symtop = { motion: kernel.motion.bind(kernel), run: () => top.json };
    Object.assign(window, { symtop });
    const scene = openScene(top);
    top.tell = guard("texts", page.receive.bind(page));
    top.draw = guard("scene", scene.draw.bind(scene));
    top.begin = guard("scene", scene.begin.bind(scene));
    top.advance = guard("motion", top.advance.bind(top));
    page.connect(top, source);
    offerSheets(content.lesson, createShoot(scene, kernel, { ...content, layers: LAYERS }));
    top.open();
  } catch (error) {
    // In English: it may be the texts that are missing.
    close(`the top cannot be shown: ${error instanceof Error ? error.message : error}`);
    console.error(error);
  }
};
