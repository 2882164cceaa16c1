// Times of the frames of an MP4 or QuickTime file, from its index: ISO/IEC 14496-12, 8.6. A browser need
// not give them.

/** @typedef {{type: string, begin: number, end: number}} Box contents of a box, from a place to another */

const LARGEST = 64 << 20; // bytes of an index: that of a film of days
const HEADER = 16; // bytes of the longest header of a box

/** @param {DataView} view @param {number} place */
const readType = (view, place) =>
  String.fromCharCode(...[0, 1, 2, 3].map((k) => view.getUint8(place + k)));

/**
 * The box at a place.
 * @param {DataView} view with its header @param {number} place in the view
 * @param {number} offset of the view @param {number} end of what holds the box @returns {Box}
 */
const readBox = (view, place, offset, end) => {
  const size = view.getUint32(place);
  const begin = offset + place;
  const isLong = size === 1;
  const length = isLong ? Number(view.getBigUint64(place + 8)) : size || end - begin;
  const inside = begin + (isLong ? 16 : 8);
  return { type: readType(view, place + 4), begin: inside, end: begin + Math.max(length, 8) };
};

/** The boxes in a part of an index. @param {DataView} view @param {number} begin @param {number} end */
const listBoxes = (view, begin, end) => {
  const boxes = [];
  for (let place = begin; place + 8 <= end; ) {
    const box = readBox(view, place, 0, end);
    if (box.end > end) break;
    boxes.push(box);
    place = box.end;
  }
  return boxes;
};

/** The box at the end of a path. @param {DataView} view @param {Box} box @param {string[]} path @returns {Box | undefined} */
const findBox = (view, box, path) => {
  if (!path.length) return box;
  const next = listBoxes(view, box.begin, box.end).find(({ type }) => type === path[0]);
  return next && findBox(view, next, path.slice(1));
};

/** The index of a film; null if there is none. @param {Blob} file */
const readIndex = async (file) => {
  for (let place = 0; place + 8 <= file.size; ) {
    const head = new DataView(await file.slice(place, place + HEADER).arrayBuffer());
    if (head.byteLength < HEADER) return null;
    const { type, begin, end } = readBox(head, 0, place, file.size);
    if (type === "moov" && end - begin <= LARGEST)
      return new DataView(await file.slice(begin, end).arrayBuffer());
    place = end;
  }
  return null;
};

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

/** Times of a track in s. @param {DataView} view @param {Box} track @param {number} filmScale */
const readTrack = (view, track, filmScale) => {
  const find = (/** @type {string[]} */ ...path) => findBox(view, track, path);
  const [header, steps] = [find("mdia", "mdhd"), find("mdia", "minf", "stbl", "stts")];
  if (!header || !steps) return [];
  const offsets = find("mdia", "minf", "stbl", "ctts");
  const shifts = offsets ? spread(readRuns(view, offsets, true)) : [];
  const { late, from } = readEdits(view, find("edts", "elst"));
  const scale = readScale(view, header);
  let decoded = -from;
  return spread(readRuns(view, steps, false)).map((step, k) => {
    const time = (decoded + (shifts[k] ?? 0)) / scale + late / filmScale;
    decoded += step;
    return time;
  });
};

/** @param {DataView} view @param {Box} track */
const isPicture = (view, track) => {
  const handler = findBox(view, track, ["mdia", "hdlr"]);
  return handler !== undefined && readType(view, handler.begin + 8) === "vide";
};

/**
 * Times of the frames in s, growing; null if the file has no index that can be read, [] without pictures.
 * @param {Blob} file @returns {Promise<number[] | null>}
 */
export const readMp4Times = async (file) => {
  const view = await readIndex(file);
  if (!view) return null;
  const boxes = listBoxes(view, 0, view.byteLength);
  const header = boxes.find(({ type }) => type === "mvhd");
  const track = boxes.find((box) => box.type === "trak" && isPicture(view, box));
  if (!header || !track) return [];
  const times = readTrack(view, track, readScale(view, header)).sort((a, b) => a - b);
  // Frames before the beginning are decoded, and not shown.
  const first = times.findIndex((_, k) => k + 1 === times.length || times[k + 1] > 0);
  if (boxes.some(({ type }) => type === "mvex") && !times.length) return null; // fragments
  return times.slice(Math.max(first, 0)).map((each) => Math.max(each, 0));
};
