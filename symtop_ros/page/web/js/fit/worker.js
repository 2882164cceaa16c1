// The fit in a thread of its own, so that the page does not stop: it takes a record, and sends parts and the
// answer.

import { Kernel } from "../physics/kernel.js";
import { describeFit } from "./answer.js";
import { fitMotion } from "./fitting.js";
import { Many } from "./many.js";
import { makeRecord } from "./record.js";

/** @typedef {{code: ArrayBuffer, given: import("./record.js").Given, top: import("../physics/kernel.js").Top}} Task */
/** @typedef {{part?: number, fitted?: import("./answer.js").Fitted, refusal?: string, error?: string}} News */

/** @param {News} news */
const send = (news) => globalThis.postMessage(news);

/** @param {Task} task */
const work = async ({ code, given, top }) => {
  try {
    const record = makeRecord(given);
    const many = new Many(await Kernel.load(code));
    const fit = fitMotion(many, record, (part) => send({ part }));
    send({ fitted: describeFit(fit, top) });
  } catch (error) {
    const text = error instanceof Error ? error.message : String(error);
    send(error instanceof RangeError ? { refusal: text } : { error: text });
  }
};

export const serve = () => {
  globalThis.addEventListener("message", ({ data }) => work(data));
};
