// The beginning of the page: the kernel, the top, its scene, and the page around it.

import { LAYERS } from "./scene/colors.js";
import { Kernel } from "./physics/kernel.js";
import { LocalTop } from "./run/local.js";
import { NodeTop } from "./run/node.js";
import { turnByKeys } from "./controls/keys.js";
import { guard, refuse, showLoss } from "./controls/notices.js";
import { Page } from "./page.js";
import { Scene } from "./scene/scene.js";
import { find } from "./controls/document.js";
import { copyPage, readData } from "./run/files.js";
import { Writer } from "./words/wording.js";

/**
 * What the file holds: the module in base64, the templates, scenes, the lesson and the fields of a run;
 * what it opens as the end of an address does; a run, if one was saved; and the name of a node, if it
 * shows one.
 * @typedef {{kernel: string, templates: {[key: string]: string}, scenes: any[], lesson: any[],
 *   run_fields: import("./run/reader.js").Table, opening?: string, run?: any, node?: string}} Content
 */

/** @param {string} text base64 */
const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

export const start = async () => {
  const source = copyPage();
  /** @type {Content} */
  const content = { ...readData("top-content"), run: readData("top-run") };
  const page = new Page(content);
  try {
    const kernel = await Kernel.load(decode(content.kernel));
    const Top = content.node ? NodeTop : LocalTop;
    const top = new Top(kernel, new Writer(content.templates), { ...content, layers: LAYERS });
    // For scripts of the page: motions of their own, and the run as in run.json.
    const symtop = { motion: kernel.motion.bind(kernel), run: () => top.json };
    Object.assign(window, { symtop });
    const scene = new Scene(find("scene"), top);
    turnByKeys(scene.camera);
    scene.tellLoss = (text) => showLoss(text, "picture-lost");
    top.tell = guard("the texts", page.receive.bind(page));
    top.draw = guard("the scene", scene.draw.bind(scene));
    top.begin = guard("the scene", scene.begin.bind(scene));
    top.advance = guard("the motion", top.advance.bind(top));
    page.connect(top, source);
    top.open();
  } catch (error) {
    refuse(`the top cannot be shown: ${error instanceof Error ? error.message : error}`);
    console.error(error);
  }
};
