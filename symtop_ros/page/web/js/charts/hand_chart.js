// What the hand feels: bars of the outer ring and of the stand.

import { find, say } from "../controls/document.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";
import { draw, LEFT, RIGHT, WIDE } from "./plot.js";

/** @import { Hand } from "../words/hand.js" */

const HEIGHT = 74;
const [UPPER, APART, THICK] = [14, 30, 12]; // of the first bar, between bars, of each
/** @type {[name: "ring" | "stand", color: string][]} */
const BARS = [
  ["ring", "var(--phi)"],
  ["stand", "var(--grey)"],
];

/** @param {Hand | null} hand @param {boolean} isSeen whether the drawing is in sight */
export const drawHand = (hand, isSeen = true) => {
  find("hand-chart").hidden = !hand;
  if (!hand) return;
  const sentence = phrase("hand", hand);
  say("hand-text", sentence);
  if (!isSeen) return;
  const most = Math.max(Math.abs(hand.ring), hand.stand) || 1;
  const bars = BARS.map(([name, color], k) => {
    const size = Math.abs(hand[name]);
    const [y, width] = [UPPER + APART * k, (size / most) * (WIDE - LEFT - RIGHT)];
    const text = `${phrase(`hand.${name}`)}: ${shorten(size, 3)} ${phrase(`hand.unit_${hand.kind}`)}`;
    return `<text class="tick" x="${LEFT}" y="${y - 3}">${text}</text>
      <rect id="hand-${name}" x="${LEFT}" y="${y}" width="${width.toFixed(1)}" height="${THICK}" fill="${color}"/>`;
  });
  draw("hand", HEIGHT, bars.join(""), sentence);
};
