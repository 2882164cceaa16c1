// Times of the frames of an MP4 or QuickTime file, from its index: ISO/IEC 14496-12, 8.6. A browser need
// not give them.

import { findBox, listBoxes, readContents, readType, walkBoxes } from "./boxes.js";
import { readPiece } from "./pieces.js";

/** @import { Box } from "./boxes.js" */

/** Runs of a table: a count and a number each. @param {DataView} view @param {Box} box @param {boolean} isSigned */
const readRuns = (view, { begin }, isSigned) =>
  Array.from({ length: view.getUint32(begin + 4) }, (_, k) => {
    const place = begin + 8 + 8 * k;
    const number = isSigned ? view.getInt32(place + 4) : view.getUint32(place + 4);
    return { count: view.getUint32(place), number };
  });

/** @param {{count: number, number: number}[]} runs */
const spread = (runs) => runs.flatMap(({ count, number }) => Array(count).fill(number));

/** Units in a second, of mdhd or mvhd. @param {DataView} view @param {Box} box */
const readScale = (view, { begin }) => view.getUint32(begin + (view.getUint8(begin) ? 20 : 12));

/**
 * How much later a track begins, and from which place of it, in units of the film and of the track.
 * @param {DataView} view @param {Box | undefined} box
 */
const readEdits = (view, box) => {
  let late = 0;
  if (!box) return { late, from: 0 };
  const isLong = view.getUint8(box.begin) === 1;
  const count = view.getUint32(box.begin + 4);
  for (let k = 0; k < count; k += 1) {
    const place = box.begin + 8 + k * (isLong ? 20 : 12);
    const from = isLong ? Number(view.getBigInt64(place + 8)) : view.getInt32(place + 4);
    if (from >= 0) return { late, from };
    late += isLong ? Number(view.getBigUint64(place)) : view.getUint32(place);
  }
  return { late, from: 0 };
};

/** Times of a track by its tables, in its units. @param {DataView} view @param {Box} track */
const readTables = (view, track) => {
  const tables = findBox(view, track, ["mdia", "minf", "stbl"]);
  const steps = tables && findBox(view, tables, ["stts"]);
  if (!steps) return [];
  const offsets = findBox(view, tables, ["ctts"]);
  const shifts = offsets ? spread(readRuns(view, offsets, true)) : [];
  let decoded = 0;
  return spread(readRuns(view, steps, false)).map((step, k) => {
    const time = decoded + (shifts[k] ?? 0);
    decoded += step;
    return time;
  });
};

/** @param {DataView} view @param {Box} track */
const isPicture = (view, track) => {
  const handler = findBox(view, track, ["mdia", "hdlr"]);
  return handler !== undefined && readType(view, handler.begin + 8) === "vide";
};

/** The track of the pictures in an index: its number, its units in a second, and how it is moved. @param {DataView} view */
const readIndex = (view) => {
  const boxes = listBoxes(view, 0, view.byteLength);
  const film = boxes.find(({ type }) => type === "mvhd");
  const track = boxes.find((box) => box.type === "trak" && isPicture(view, box));
  const header = track && findBox(view, track, ["mdia", "mdhd"]);
  const own = track && findBox(view, track, ["tkhd"]);
  if (!film || !track || !header || !own) return null;
  const scale = readScale(view, header);
  const { late, from } = readEdits(view, findBox(view, track, ["edts", "elst"]));
  return {
    number: view.getUint32(own.begin + (view.getUint8(own.begin) ? 20 : 12)),
    step: readUsualStep(view, boxes),
    place: (/** @type {number} */ time) => (time - from) / scale + late / readScale(view, film),
    times: readTables(view, track),
  };
};

/** Units between two frames of pieces that say nothing else. @param {DataView} view @param {Box[]} boxes */
const readUsualStep = (view, boxes) => {
  const all = boxes.find(({ type }) => type === "mvex");
  const usual = all && findBox(view, all, ["trex"]);
  return usual ? view.getUint32(usual.begin + 12) : 0;
};

/**
 * Times of the frames in s, growing; null if the file has no index that can be read, [] without pictures.
 * @param {Blob} file @returns {Promise<number[] | null>}
 */
export const readMp4Times = async (file) => {
  /** @type {ReturnType<typeof readIndex>} */
  let index = null;
  let hasIndex = false;
  /** @type {number[]} */
  const units = [];
  for await (const box of walkBoxes(file)) {
    if (box.type !== "moov" && box.type !== "moof") continue;
    const view = await readContents(file, box);
    if (!view) return null;
    if (box.type === "moov") {
      hasIndex = true;
      index = readIndex(view);
      units.push(...(index?.times ?? []));
    } else if (index) units.push(...readPiece(view, index.number, index.step));
  }
  const { place } = index ?? {};
  if (!place) return hasIndex ? [] : null;
  const times = units.map(place).sort((a, b) => a - b);
  // Frames before the beginning are decoded, and not shown.
  const first = times.findIndex((_, k) => k + 1 === times.length || times[k + 1] > 0);
  return times.slice(Math.max(first, 0)).map((each) => Math.max(each, 0));
};
