// What a page holds packed: by gzip, in base 85 (RFC 1924), with another letter in place of <.

const LETTERS =
  "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"; // as join.py

/** Bytes: five letters are four of them, and fewer at the end. @param {string} text base 85 */
const decode = (text) => {
  const values = new Map([...LETTERS].map((letter, k) => [letter, k]));
  const view = new DataView(new ArrayBuffer(4 * Math.ceil(text.length / 5)));
  for (let k = 0; k < text.length; k += 5) {
    let sum = 0;
    for (let j = k; j < k + 5; j += 1) sum = 85 * sum + (values.get(text[j] ?? "~") ?? 0);
    view.setUint32((4 * k) / 5, sum);
  }
  return view.buffer.slice(0, Math.floor((4 * text.length) / 5));
};

/** @param {string} text base 85 */
export const unpack = (text) => {
  const packed = new Blob([decode(text)]).stream();
  return new Response(packed.pipeThrough(new DecompressionStream("gzip")));
};
