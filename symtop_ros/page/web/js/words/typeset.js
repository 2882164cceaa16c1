// Symbols in texts as formulas: theta'' as MathML, and the text itself as it came beside them.

const SPACE = "http://www.w3.org/1998/Math/MathML";
/** @type {{[name: string]: string}} */
const LETTERS = {
  theta: "\u03b8",
  phi: "\u03c6",
  psi: "\u03c8",
  omega: "\u03c9",
  lambda: "\u03bb",
};
const CLOSING = [".", ",", ":", ";", ")"];
// Dots of derivatives by time, as many as primes. Full stops, which stand on their line: WebKit places
// a line of text over the letter, and the sign \u02d9 would float high in its line.
const DOTS = ["", ".", ".."];
// In every language: no L begins Lösung, nor l’axe.
const SYMBOL =
  /(?<![\p{L}\d_])(theta|phi|psi|omega|lambda|p|L|U|u|E|I|Mgl|Ix|Iy|Iz)(?:_(phi|psi|eff|[xyz0]))?('{0,2})(?:\^(\d))?(?![\p{L}\d_'’])|(rad\/s|kg m|\))\^2/gu;

/** @param {string} name @param {(Node | string)[]} children */
const create = (name, ...children) => {
  const element = document.createElementNS(SPACE, name);
  element.append(...children);
  return element;
};

/** @param {string} text */
const createLetter = (text) => create("mi", LETTERS[text] ?? text);

/**
 * A symbol with its dots, index and power. A prime of an angle is a derivative by time, and a dot
 * in formulas; that of another letter, as of L_z', stays a prime.
 * @param {string} letter
 * @param {string | undefined} index
 * @param {string} primes
 * @param {string | undefined} power
 */
const createSymbol = (letter, index, primes, power) => {
  const [, base, axis] = letter.match(/^(I)([xyz])$/) ?? [null, letter, index];
  let symbol = createLetter(base);
  const isAngle = base in LETTERS;
  if (axis) symbol = create("msub", symbol, createLetter(axis));
  if (primes && isAngle) symbol = create("mover", symbol, create("mtext", DOTS[primes.length]));
  else if (primes) symbol = create("mrow", symbol, create("mo", "\u2032"));
  if (power) symbol = create("msup", symbol, create("mn", power));
  return symbol;
};

/** Whether a match is a symbol, and not a word of one letter. @param {RegExpMatchArray} match */
const isSymbol = ([, letter, index, primes, power]) =>
  letter.length > 1 ||
  Boolean(index ?? power) ||
  (primes !== "" && letter === "E") ||
  letter === "L";

const WORD = /\[([^|\]]+)\|([^|\]]+)\]/;

/**
 * A word that names an arrow of the scene, as a button of its colour.
 * @param {string} text @param {string} layer
 */
const createWord = (text, layer) => {
  const word = document.createElement("button");
  word.className = "word";
  word.dataset.layer = layer;
  word.append(...typesetSymbols(text));
  return word;
};

/**
 * The parts of a text: its symbols as formulas, and the words that name an arrow, [torque|torque].
 * @param {string} text @returns {(Node | string)[]}
 */
export const typeset = (text) => {
  const parts = text.split(WORD);
  return parts.flatMap((part, k) => {
    if (k % 3 === 2) return [];
    return k % 3 ? [createWord(part, parts[k + 1])] : typesetSymbols(part);
  });
};

/** The parts of a text, with its symbols as formulas. @param {string} text @returns {(Node | string)[]} */
export const typesetSymbols = (text) => {
  /** @type {(Node | string)[]} */
  const parts = [];
  let end = 0;
  for (const match of text.matchAll(SYMBOL)) {
    const [whole, letter, index, primes, power, unit] = match;
    if (!unit && !isSymbol(match)) continue;
    parts.push(text.slice(end, match.index));
    end = match.index + whole.length;
    if (unit) {
      parts.push(`${unit}\u00b2`);
      continue;
    }
    const formula = create("math", createSymbol(letter, index, primes, power));
    parts.push(formula);
    if (!CLOSING.includes(text[end])) continue;
    formula.append(create("mtext", text[end])); // no line begins with a full stop
    end += 1;
  }
  return [...parts, text.slice(end)].filter((part) => part !== "");
};
