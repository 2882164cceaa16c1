// The beginning of the page: the kernel, the top, its scene, and the page around it.

import { Kernel } from "./kernel.js";
import { LocalTop } from "./local.js";
import { refuse } from "./notices.js";
import { Page } from "./page.js";
import { LAYERS, Scene } from "./scene.js";
import { find } from "./document.js";
import { Writer } from "./wording.js";

/**
 * What the file holds: the module in base64, the templates, scenes and the lesson; a run, if one
 * was saved; and whether it shows a running node.
 * @typedef {{kernel: string, templates: {[key: string]: string}, scenes: any[], lesson: any[],
 *   run?: any, node?: boolean}} Content
 */

/** @param {string} text base64 */
const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/**
 * @param {Content} content
 * @param {string} source the page as it was opened
 */
export const start = async (content, source) => {
  const page = new Page(content);
  try {
    const kernel = await Kernel.load(decode(content.kernel));
    Object.assign(window, { symtop: { motion: kernel.motion.bind(kernel) } });
    const top = new LocalTop(kernel, new Writer(content.templates), { ...content, layers: LAYERS });
    const scene = new Scene(find("scene"), top);
    top.tell = (message) => page.receive(message);
    top.draw = (state, states) => scene.draw(state, states);
    top.begin = () => scene.begin();
    page.connect(top, source);
    top.open();
  } catch (error) {
    refuse(`the top cannot be shown: ${error instanceof Error ? error.message : error}`);
    console.error(error);
  }
};
