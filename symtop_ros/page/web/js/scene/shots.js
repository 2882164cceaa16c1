// Pictures of the steps of the lesson, by a top of their own: the run of the page stays.

import { NANO } from "../physics/course.js";
import { LocalTop } from "../run/local.js";
import { drawSmall } from "./picture.js";

/** @import { Kernel } from "../physics/kernel.js" */
/** @import { Message } from "../run/acts.js" */
/** What draws another top for a while. @typedef {{lend: (top: LocalTop, work: () => Element) => Element}} Lender */
/** @typedef {{messages: Message[], layers: string[]}} Shot what is asked for, and shown */

const LONGEST = 1; // s after an act

/** Go on until much of what follows is seen. @param {LocalTop} top */
const watch = (top) => {
  const half = top.telling.free.motion.nutation_period / 2;
  top.step(Math.round(Math.min(half || LONGEST, LONGEST) * NANO));
};

/** @param {Lender} scene @param {Kernel} kernel @param {ConstructorParameters<typeof LocalTop>[1]} content */
export const createShoot =
  (scene, kernel, content) =>
  (/** @type {Shot} */ { messages, layers }) => {
    const top = new LocalTop(kernel, content);
    for (const message of messages) {
      top.take(message);
      watch(top);
    }
    top.layers = { ...content.layers, ...Object.fromEntries(layers.map((each) => [each, true])) };
    return scene.lend(top, drawSmall);
  };
