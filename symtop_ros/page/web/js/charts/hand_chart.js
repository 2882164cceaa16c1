// What a hand feels: bars of the outer ring and of the stand.

import { say } from "../controls/document.js";
import { ROUNDING } from "../words/ledger.js";
import { shorten } from "../words/quantities.js";
import { phrase } from "../words/wording.js";
import { draw, LEFT, WIDE } from "./plot.js";

/** @import { Hand } from "../words/hand.js" */

const HEIGHT = 74;
const [UPPER, APART, THICK] = [16, 34, 12]; // of the first bar, from bar to bar, of each
const LONGEST = WIDE - 2 * LEFT;
/** @type {[name: "ring" | "stand", color: string][]} */
const BARS = [
  ["ring", "var(--phi)"],
  ["stand", "var(--grey)"],
];

/** @param {Hand | null} hand */
export const drawHand = (hand) => {
  if (!hand) return;
  const sizes = BARS.map(([name]) => Math.abs(hand[name])).map((size) =>
    size > ROUNDING * hand.most ? size : 0,
  );
  const unit = hand.kind === "push" ? "N m s" : "N m";
  const texts = BARS.map(
    ([name], k) => `${phrase(`hand.${name}`)}: ${shorten(sizes[k], 3)} ${unit}`,
  );
  const bars = BARS.map(([name, color], k) => {
    const [y, width] = [UPPER + APART * k, ((sizes[k] / (hand.most || 1)) * LONGEST).toFixed(1)];
    return `<text class="tick" x="${LEFT}" y="${y - 4}">${texts[k]}</text>
      <rect id="hand-${name}" x="${LEFT}" y="${y}" width="${width}" height="${THICK}" fill="${color}"/>`;
  });
  const sentence = phrase(`hand.${hand.kind}`);
  draw("hand", HEIGHT, bars.join(""), `${sentence} ${texts.join("; ")}`);
  say("hand-text", sentence);
};
