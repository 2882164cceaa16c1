// Times of frames in a piece of an MP4 file, as browsers and screen recorders write it: ISO/IEC 14496-12, 8.8.

import { findBox, listBoxes } from "./boxes.js";

/** @import { Box } from "./boxes.js" */

// Flags: what follows the head of tfhd, and each frame of trun.
const [BASE, DESCRIPTION, STEP] = [0x1, 0x2, 0x8];
const [OFFSET, FIRST_FLAGS] = [0x1, 0x4];
const [DURATION, SIZE, FLAGS, SHIFT] = [0x100, 0x200, 0x400, 0x800];

/** @param {DataView} view @param {Box} box */
const readFlags = (view, { begin }) => view.getUint32(begin) & 0xffffff;

/** The number of the track, and the units between two frames if it says so. @param {DataView} view @param {Box} head */
const readHead = (view, head) => {
  const flags = readFlags(view, head);
  const place = head.begin + 8 + (flags & BASE ? 8 : 0) + (flags & DESCRIPTION ? 4 : 0);
  return {
    number: view.getUint32(head.begin + 4),
    step: flags & STEP ? view.getUint32(place) : null,
  };
};

/** Units at which the first frame is decoded. @param {DataView} view @param {Box | undefined} box */
const readBegin = (view, box) => {
  if (!box) return 0;
  const isLong = view.getUint8(box.begin) === 1;
  return isLong ? Number(view.getBigUint64(box.begin + 4)) : view.getUint32(box.begin + 4);
};

/**
 * Times of the frames of a run, and when the next one is decoded.
 * @param {DataView} view @param {Box} run @param {number} begin @param {number} usual step
 */
const readRun = (view, run, begin, usual) => {
  const flags = readFlags(view, run);
  const has = (/** @type {number} */ flag) => (flags & flag ? 4 : 0);
  const width = has(DURATION) + has(SIZE) + has(FLAGS) + has(SHIFT);
  const first = run.begin + 8 + has(OFFSET) + has(FIRST_FLAGS);
  let decoded = begin;
  const times = Array.from({ length: view.getUint32(run.begin + 4) }, (_, k) => {
    const place = first + k * width;
    const shift = flags & SHIFT ? view.getInt32(place + width - 4) : 0;
    const time = decoded + shift;
    decoded += flags & DURATION ? view.getUint32(place) : usual;
    return time;
  });
  return { times, end: decoded };
};

/**
 * Times of the frames of a track in a piece, in its units.
 * @param {DataView} view contents of moof @param {number} number of the track @param {number} usual step
 */
export const readPiece = (view, number, usual) => {
  /** @type {number[]} */
  const times = [];
  for (const track of listBoxes(view, 0, view.byteLength)) {
    const head = track.type === "traf" && findBox(view, track, ["tfhd"]);
    if (!head) continue;
    const { number: own, step } = readHead(view, head);
    if (own !== number) continue;
    let begin = readBegin(view, findBox(view, track, ["tfdt"]));
    for (const box of listBoxes(view, track.begin, track.end)) {
      if (box.type !== "trun") continue;
      const run = readRun(view, box, begin, step ?? usual);
      times.push(...run.times);
      begin = run.end;
    }
  }
  return times;
};
