// The fit as the page asks for it: a thread is begun for each, and ended with it.

/** @import { Fitted } from "./answer.js" */
/** @import { Given } from "./record.js" */
/** @import { Top } from "../physics/kernel.js" */

export class Fitting {
  /**
   * @param {string} script the text of the page's script, which serves fits if there is no document
   * @param {ArrayBuffer} code of the kernel @param {Top} top whose moments stand for unknown ones
   */
  constructor(script, code, top) {
    this.url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.code = code;
    this.top = top;
    /** @type {Worker | null} */
    this.worker = null;
  }

  /**
   * The motion that explains a record; a RangeError says why there is none.
   * @param {Given} given @param {(part: number) => void} report is called with the part that is done
   * @returns {Promise<Fitted>}
   */
  fit(given, report = () => {}) {
    this.stop();
    const worker = new Worker(this.url);
    this.worker = worker;
    return new Promise((resolve, reject) => {
      const end = (/** @type {() => void} */ settle) => {
        worker.terminate();
        if (this.worker === worker) this.worker = null;
        settle();
      };
      worker.onerror = ({ message }) => end(() => reject(new Error(message)));
      worker.onmessage = ({ data }) => {
        if (data.part !== undefined) report(data.part);
        else if (data.fitted) end(() => resolve(data.fitted));
        else if (data.refusal) end(() => reject(new RangeError(data.refusal)));
        else end(() => reject(new Error(data.error)));
      };
      worker.postMessage({ code: this.code, given, top: this.top });
    });
  }

  /** End a fit that is running; its promise stays open. */
  stop() {
    this.worker?.terminate();
    this.worker = null;
  }
}
