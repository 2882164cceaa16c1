// The first script of the page: it unpacks the script that is the page, which the policy knows by its hash.

import { unpack } from "./packed.js";

/** @param {string} id */
const take = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** In English: the texts are not unpacked either. @param {unknown} error */
const tell = (error) => {
  const reason = error instanceof Error ? error.message : error;
  take("lost").textContent = `the top cannot be shown: ${reason}`;
  take("lost").hidden = false;
  console.error(error);
};

export const load = async () => {
  try {
    const script = document.createElement("script");
    script.textContent = await unpack(take("top-script").textContent ?? "").text();
    document.body.append(script);
  } catch (error) {
    tell(error);
  }
};
