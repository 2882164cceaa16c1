// Boxes of an MP4 or QuickTime file: ISO/IEC 14496-12, 4.2.

/** @typedef {{type: string, begin: number, end: number}} Box contents of a box, from a place to another */

const LARGEST = 64 << 20; // bytes of an index: that of a film of days
const HEADER = 16; // bytes of the longest header of a box

/** @param {DataView} view @param {number} place */
export const readType = (view, place) =>
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
export const listBoxes = (view, begin, end) => {
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
export const findBox = (view, box, path) => {
  if (!path.length) return box;
  const next = listBoxes(view, box.begin, box.end).find(({ type }) => type === path[0]);
  return next && findBox(view, next, path.slice(1));
};

/**
 * The boxes of a file, one after another.
 * @param {Blob} file @returns {AsyncGenerator<Box>}
 */
export const walkBoxes = async function* (file) {
  for (let place = 0; place + 8 <= file.size; ) {
    const head = new DataView(await file.slice(place, place + HEADER).arrayBuffer());
    if (head.byteLength < HEADER) return;
    const box = readBox(head, 0, place, file.size);
    yield box;
    place = box.end;
  }
};

/** The contents of a box; null if they are too long for an index. @param {Blob} file @param {Box} box */
export const readContents = async (file, { begin, end }) =>
  end - begin <= LARGEST ? new DataView(await file.slice(begin, end).arrayBuffer()) : null;
