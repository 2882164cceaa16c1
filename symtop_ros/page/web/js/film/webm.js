// Times of the frames of a WebM or Matroska file, from the heads of its blocks: RFC 9559. A browser need
// not give them.

const LARGEST = 1 << 29; // bytes; of a longer film the heads of all blocks take too long
const PIECE = 1 << 18; // bytes that are read at once
const LONGEST = 12; // bytes of the head of an element, and those of a block that are looked at
// Elements, by the names of the RFC.
const TIMESTAMP_SCALE = 0x2ad7b1;
const TRACK_ENTRY = 0xae;
const TRACK_NUMBER = 0xd7;
const TRACK_TYPE = 0x83;
const TIMESTAMP = 0xe7;
const BLOCKS = [0xa3, 0xa1]; // SimpleBlock, Block
// Segment, Info, Tracks, Cluster, BlockGroup and TrackEntry hold others.
const HOLDERS = [0x18538067, 0x1549a966, 0x1654ae6b, 0x1f43b675, 0xa0, TRACK_ENTRY];
const PICTURES = 1; // TrackType

/** A file of which a piece is in memory. */
class Pieces {
  /** @param {Blob} file */
  constructor(file) {
    this.file = file;
    this.begin = 0;
    this.view = new DataView(new ArrayBuffer(0));
  }

  /** Bytes from a place on; fewer at the end. @param {number} place @param {number} length */
  async read(place, length) {
    const end = Math.min(place + length, this.file.size);
    if (place < this.begin || end > this.begin + this.view.byteLength) {
      this.begin = place;
      this.view = new DataView(await this.file.slice(place, place + PIECE).arrayBuffer());
    }
    const { buffer } = this.view;
    return new DataView(buffer, place - this.begin, Math.max(end - place, 0));
  }
}

/** A number of variable length, and how long it is. @param {DataView} view @param {number} place @param {boolean} isId */
const readVariable = (view, place, isId) => {
  const first = view.getUint8(place);
  const length = Math.clz32(first) - 23;
  let value = isId ? first : first & (0xff >> length);
  for (let k = 1; k < length; k += 1) value = 256 * value + view.getUint8(place + k);
  return { value, length };
};

/** A whole number. @param {DataView} view */
const readWhole = (view) => {
  let value = 0;
  for (let k = 0; k < view.byteLength; k += 1) value = 256 * value + view.getUint8(k);
  return value;
};

/** The element at a place: its id, and where its contents are. @param {Pieces} pieces @param {number} place */
const readHead = async (pieces, place) => {
  const view = await pieces.read(place, LONGEST);
  const id = readVariable(view, 0, true);
  const size = readVariable(view, id.length, false);
  const begin = place + id.length + size.length;
  return { id: id.value, begin, size: size.value };
};

/** What the heads of a file say. */
class Walk {
  scale = 1e6; // ns of a unit of time
  cluster = 0; // units
  track = { number: 0, type: 0 };
  pictures = 0; // number of their track
  /** @type {number[]} */
  times = []; // units

  /** @param {number} id @param {DataView} view */
  take(id, view) {
    if (id === TIMESTAMP_SCALE) this.scale = readWhole(view);
    else if (id === TIMESTAMP) this.cluster = readWhole(view);
    else if (id === TRACK_NUMBER) this.track.number = readWhole(view);
    else if (id === TRACK_TYPE) this.track.type = readWhole(view);
    else if (BLOCKS.includes(id)) this.takeBlock(view);
    const { number, type } = this.track;
    if (!this.pictures && type === PICTURES) this.pictures = number;
  }

  /** @param {DataView} view */
  takeBlock(view) {
    const { value, length } = readVariable(view, 0, false);
    if (value === this.pictures) this.times.push(this.cluster + view.getInt16(length));
  }
}

/** @param {Pieces} pieces */
const walk = async (pieces) => {
  const found = new Walk();
  const { size: end } = pieces.file;
  for (let place = 0; place + 2 <= end; ) {
    const { id, begin, size } = await readHead(pieces, place);
    if (id === TRACK_ENTRY) found.track = { number: 0, type: 0 };
    if (!HOLDERS.includes(id) && size)
      found.take(id, await pieces.read(begin, Math.min(size, LONGEST)));
    place = HOLDERS.includes(id) ? begin : begin + size;
  }
  return found;
};

/**
 * Times of the frames in s, growing; null if the file is too long or cut off, [] without pictures.
 * @param {Blob} file @returns {Promise<number[] | null>}
 */
export const readWebmTimes = async (file) => {
  if (file.size > LARGEST) return null;
  try {
    const { times, scale, track } = await walk(new Pieces(file));
    if (!track.number) return null;
    return times.sort((a, b) => a - b).map((each) => (each * scale) / 1e9);
  } catch (error) {
    if (error instanceof RangeError) return null; // a head that is cut off
    throw error;
  }
};
