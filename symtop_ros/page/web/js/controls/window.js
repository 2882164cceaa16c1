// What the page asks of the window and the system: a full screen, and to copy its link, or to take a
// picture of it.

import { generate } from "./lean_qr.js";
import { find, say } from "./document.js";
import { phrase } from "../words/wording.js";

const MOMENT = 2000; // ms

/** A frame or a phone may have no full screen. */
export const offerFullScreen = () => {
  const button = find("full");
  button.hidden = !document.fullscreenEnabled;
  button.addEventListener("click", () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen();
  });
};

/** Copy the link of the start; where the system forbids it, it is marked, to be copied by hand. */
export const offerCopy = () => {
  const link = find("link", HTMLInputElement);
  find("copy-link").addEventListener("click", async () => {
    link.select();
    try {
      await navigator.clipboard.writeText(link.value);
    } catch {
      return;
    }
    say("copy-link", phrase("page.copied"));
    setTimeout(() => say("copy-link", phrase("page.copy_link")), MOMENT);
  });
};

let drawn = "";

/**
 * Show the link of the start, and its code for a camera. Another machine finds no page that was opened from
 * a file.
 * @param {string} address
 */
export const showLink = (address) => {
  find("link", HTMLInputElement).value = address;
  const code = find("code", HTMLCanvasElement);
  code.hidden = !address.startsWith("http");
  if (code.hidden || address === drawn) return;
  generate(address).toCanvas(code);
  drawn = address;
};
