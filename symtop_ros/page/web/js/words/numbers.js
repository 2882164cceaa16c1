// Twin of the rounding in words/templates.py: how a number is written, in every sentence, with the
// decimal point of the language.

const [SMALLEST_RATE, LARGEST_RATE] = [0.1, 1e5]; // rad/s; others are written with three digits
const DIGITS = 100; // which browsers write exactly, at most
const WHOLE = 1e21; // from here on browsers write an exponent

/**
 * Whether exactly half is left from a place on, after an even digit: of two equally near numbers
 * the even one is wanted, where browsers write the larger.
 * @param {string} digits @param {number} place
 */
const isHalfAboveEven = (digits, place) =>
  /^50*$/.test(digits.slice(place)) && /[02468]$/.test(digits.slice(0, place));

/** With a number of decimals. @param {number} size @param {number} decimals */
const writeFixed = (size, decimals) => {
  if (size >= WHOLE) return `${BigInt(size)}${decimals ? `.${"0".repeat(decimals)}` : ""}`;
  const all = size.toFixed(DIGITS);
  const digits = all.replace(".", "");
  if (!isHalfAboveEven(digits, digits.length - DIGITS + decimals)) return size.toFixed(decimals);
  return all.slice(0, all.length - DIGITS + (decimals || -1));
};

/**
 * With a number of significant digits: these, and the exponent of the first.
 * @param {number} size @param {number} count @returns {[string, number]}
 */
const findDigits = (size, count) => {
  const [all, exact] = size.toExponential(DIGITS).replace(".", "").split("e");
  if (isHalfAboveEven(all, count)) return [all.slice(0, count), Number(exact)];
  const [digits, exponent] = size
    .toExponential(count - 1)
    .replace(".", "")
    .split("e");
  return [digits, Number(exponent)];
};

/** @param {number} exponent */
const writeExponent = (exponent) =>
  `e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;

/** @param {string} text with a point */
const dropZeros = (text) => text.replace(/\.?0*$/, "");

/** As %g of C. @param {number} size @param {number} count */
const writeGeneral = (size, count) => {
  const [digits, exponent] = findDigits(size, count);
  if (exponent < -4 || exponent >= count) {
    const text = count > 1 ? dropZeros(`${digits[0]}.${digits.slice(1)}`) : digits;
    return text + writeExponent(exponent);
  }
  if (exponent < 0) return dropZeros(`0.${"0".repeat(-exponent - 1)}${digits}`);
  const text = `${digits.slice(0, exponent + 1)}.${digits.slice(exponent + 1)}`;
  return dropZeros(text);
};

/** @param {number} size @param {number} decimals */
const writeScientific = (size, decimals) => {
  const [digits, exponent] = findDigits(size, decimals + 1);
  return `${digits[0]}.${digits.slice(1)}${writeExponent(exponent)}`;
};

let point = ".";

/** Write numbers with this decimal point from now on. @param {string} chosen */
export const setPoint = (chosen) => {
  point = chosen;
};

/** A number as JavaScript writes it, in the language of the page. @param {string} text */
export const localize = (text) => text.replace(".", point);

const WRITERS = { f: writeFixed, g: writeGeneral, e: writeScientific };

const FORM = /^(\d+)(?:to(\d+))?([fger])(deg)?$/;
export const MOST_DIGITS = 17; // which tell any two doubles apart

/** Rounded to some decimals, also to zero, as next to a deviation. @param {number} value @param {number} decimals */
export const writeRounded = (value, decimals) => {
  const text = writeFixed(Math.abs(value), decimals);
  return localize(value < 0 && Number(text) !== 0 ? `-${text}` : text);
};

/** @param {number} value @param {number} digits @param {string} letter */
const writePlain = (value, digits, letter) => {
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value < 0 ? "-inf" : "inf";
  const size = Math.abs(value);
  const text = WRITERS[/** @type {"f" | "g" | "e"} */ (letter)](size, digits);
  const isSeen = size === 0 || Number(text) !== 0;
  return localize(
    (value < 0 ? "-" : "") + (isSeen ? text : writeGeneral(size, Math.max(digits, 1))),
  );
};

/**
 * A number as text, in a format such as 3f, 3g, 2r, 1fdeg or 3to7f.
 * @param {number} given
 * @param {string} form
 * @param {number} more digits than the first of 3to7f
 * @returns {string}
 */
export const writeNumber = (given, form, more = 0) => {
  const [, least, most, letter, degrees] = /** @type {RegExpMatchArray} */ (form.match(FORM));
  const digits = Math.min(Number(least) + more, Number(most ?? least));
  const value = degrees ? (given * 180) / Math.PI : given;
  if (letter !== "r") return writePlain(value, digits, letter);
  const size = Math.abs(value);
  const isPlain = value === 0 || (SMALLEST_RATE <= size && size < LARGEST_RATE);
  return isPlain ? writePlain(value, digits, "f") : writePlain(value, digits + 1, "g");
};
