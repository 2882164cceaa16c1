// What the page asks of the window and the system: a full screen, and to copy its link.

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
