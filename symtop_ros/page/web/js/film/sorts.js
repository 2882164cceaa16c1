// What a file is, by its first bytes: a name or a type may be wrong.

const HEAD = 4096; // bytes that are looked at
const SIGN = 192; // bytes of these that may be a sign
/** @type {[Sort, RegExp][]} the first bytes as hexadecimal digits */
const SIGNS = [
  ["webm", /^1a45dfa3/], // EBML
  // PNG, JPEG, GIF, BMP, WebP, AVIF and HEIF
  [
    "picture",
    /^(89504e47|ffd8ff|47494638|424d.{8}0{8}|52494646.{8}57454250|.{8}66747970(61766966|68656963|68656978|6d696631))/,
  ],
  ["sound", /^(494433|664c6143|52494646.{8}57415645|fff[b32]|.{8}667479704d3441)/i], // ID3, FLAC, WAVE, MP3, M4A
  ["mp4", /^0.{7}(66747970|6d6f6f76|6d646174|77696465|66726565|736b6970)/], // ftyp, moov, mdat, wide, free, skip
  ["film", /^(4f676753|52494646.{8}41564920|464c5601|000001b|3026b275|47.{374}47)/], // Ogg, AVI, FLV, MPEG, ASF
];
// A run.json or a saved page, or a single value of JSON, which is none; what is left is a table.
const RUN = /^\ufeff?\s*([<{["]|(null|true|false|[-+.\de]+)\s*$)/i;

/** @typedef {"webm" | "mp4" | "film" | "picture" | "sound" | "empty" | "bytes" | "run" | "table"} Sort */

/** @param {Blob} file @returns {Promise<Sort>} */
export const findSort = async (file) => {
  const bytes = new Uint8Array(await file.slice(0, HEAD).arrayBuffer());
  if (!bytes.length) return "empty";
  const digits = Array.from(bytes.slice(0, SIGN), (each) => each.toString(16).padStart(2, "0"));
  const sign = SIGNS.find(([, pattern]) => pattern.test(digits.join("")));
  if (sign) return sign[0];
  if (bytes.includes(0)) return "bytes";
  return RUN.test(new TextDecoder().decode(bytes)) ? "run" : "table";
};
