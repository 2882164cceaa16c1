// The beginning of the page as one file: the kernel, the top, and its scene.

import { Kernel } from "./kernel.js";
import { LocalTop } from "./local.js";
import { LAYERS, Scene } from "./scene.js";
import { Writer } from "./wording.js";

/**
 * What the file holds: the module in base64, the templates, scenes and the lesson.
 * @typedef {{kernel: string, templates: {[key: string]: string}, scenes: any[], lesson: any[],
 *   run?: any}} Content
 */

/** @param {string} text base64 */
const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/**
 * Make the top of the page; `receive` is told what happens, and `place` shows the scene.
 * @param {Content} content
 * @param {HTMLElement} place
 * @param {(message: {[name: string]: any}) => void} receive
 */
export const startTop = async (content, place, receive) => {
  const kernel = await Kernel.load(decode(content.kernel));
  Object.assign(window, { symtop: { motion: kernel.motion.bind(kernel) } });
  const top = new LocalTop(kernel, new Writer(content.templates), { ...content, layers: LAYERS });
  const scene = new Scene(place, top);
  top.tell = receive;
  top.draw = (state, states) => scene.draw(state, states);
  top.begin = () => scene.begin();
  return top;
};
