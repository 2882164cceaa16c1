// Texts of the page as a book sets them: formulas as MathML, signs and units in their letters.

import { findFormulas, LETTERS } from "./formula.js";
import { speakFormula } from "./spoken.js";

/** @import { Node_, Power, Product, Quotient, Symbol_, Term } from "./formula.js" */

const SPACE = "http://www.w3.org/1998/Math/MathML";
const CLOSING = /^[.,:;?!)]+/; // no line begins with a full stop
const OPENING = /\($/;
const DOTS = ["", "\u02d9", "\u00a8"]; // of derivatives by time, as many as primes
const PRIMES = ["", "\u2032", "\u2033"];
const UNBROKEN = 3; // terms; a longer formula may end a line within it
const THIN = "0.17em";
const TIGHT = { lspace: "0", rspace: "0" };
/** Names of several letters, each of its own. @type {{[name: string]: string[]}} */
const SEVERAL = { Mgl: ["M", "g", "l"], dL: ["d", "L"], dt: ["d", "t"] };
/** @type {{[sign: string]: string}} */
const SIGNS = { "-": "\u2212", x: "\u00d7", ".": "\u00b7" };
const SUPERSCRIPTS = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";

/** @param {string} name @param {{[name: string]: string}} given @param {(Node | string)[]} children */
const createWith = (name, given, ...children) => {
  const element = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(given)) element.setAttribute(key, value);
  element.append(...children);
  return element;
};

/** @param {string} name @param {(Node | string)[]} children */
const create = (name, ...children) => createWith(name, {}, ...children);

/** One element of several. @param {Node[]} parts */
const join = (parts) => (parts.length === 1 ? parts[0] : create("mrow", ...parts));

const createGap = () => createWith("mspace", { width: THIN });

/** An operator that may begin a piece, where it would have no space. @param {string} sign */
const createOperator = (sign) => createWith("mo", { form: "infix" }, SIGNS[sign] ?? sign);

/** @param {string} name */
const createLetter = (name) => create("mi", LETTERS[name] ?? name);

/** A number is no letter. @param {string} index */
const createIndex = (index) => (/\d/.test(index) ? create("mn", index) : createLetter(index));

/** Digits as they are in texts of all kinds. @param {string} exponent */
const raise = (exponent) =>
  exponent.replace("-", "\u207b").replace(/\d/g, (digit) => SUPERSCRIPTS[Number(digit)]);

/**
 * A symbol with its dots and index. A prime of an angle is a derivative by time, and a dot in
 * formulas; that of another letter, as of L_z', stays a prime.
 * @param {Symbol_} symbol
 */
const createSymbol = ({ name, index, primes }) => {
  const [, moment, axis] = name.match(/^(I)([xyz])$/) ?? [null, name, index];
  const letter = join((SEVERAL[moment] ?? [moment]).map(createLetter));
  const base = axis ? create("msub", letter, createIndex(axis)) : letter;
  if (!primes) return base;
  if (!(name in LETTERS)) return create("mrow", base, createWith("mo", TIGHT, PRIMES[primes]));
  return createWith("mover", { accent: "true" }, base, create("mo", DOTS[primes]));
};

/** A power stands over an index. @param {Node} base @param {Element} exponent */
const raiseNode = (base, exponent) =>
  base.nodeName === "msub"
    ? create("msubsup", ...base.childNodes, exponent)
    : create("msup", base, exponent);

/** A unit stands upright behind a thin space. @param {string} unit */
const setUnit = (unit) =>
  unit
    ? [createGap(), create("mtext", unit.replace("^2", raise("2")).replaceAll(" ", "\u2009"))]
    : [];

/** The elements of a formula; its fractions have a line if they are stacked. */
class Setter {
  /** @param {boolean} isStacked */
  constructor(isStacked) {
    this.isStacked = isStacked;
  }

  /** @param {Term[]} terms @returns {Node[]} */
  setTerms(terms) {
    return terms.flatMap(({ sign, node }) => [
      ...(sign ? [createOperator(sign)] : []),
      ...this.setNode(node),
    ]);
  }

  /** @param {Node_} node @returns {Node[]} */
  setNode(node) {
    switch (node.kind) {
      case "symbol":
        return [createSymbol(node)];
      case "number":
        return [create("mn", node.text), ...setUnit(node.unit)];
      case "call":
        if (node.name === "sqrt") return [create("msqrt", ...this.setTerms(node.argument))];
        return [create("mi", node.name), ...this.setArgument(node.argument)];
      case "group":
        return this.setInBrackets(node.terms);
      case "power":
        return this.setPower(node);
      case "negative":
        return [createWith("mo", { form: "prefix" }, SIGNS["-"]), ...this.setNode(node.of)];
      case "product":
        return this.setProduct(node);
      case "quotient":
        return this.setQuotient(node);
    }
  }

  /** Brackets are no taller than a letter. @param {Term[]} terms */
  setInBrackets(terms) {
    const [open, close] = ["(", ")"].map((each) => createWith("mo", { stretchy: "false" }, each));
    return [open, ...this.setTerms(terms), close];
  }

  /** @param {Term[]} argument */
  setArgument(argument) {
    const [{ node }] = argument;
    const isPlain = argument.length === 1 && node.kind === "symbol" && !node.primes;
    return isPlain ? [createGap(), ...this.setTerms(argument)] : this.setInBrackets(argument);
  }

  /** A power of a function stands at its name. @param {Power} power */
  setPower({ base, exponent }) {
    const raised = create("mn", exponent.replace("-", SIGNS["-"]));
    if (base.kind !== "call") return [raiseNode(join(this.setNode(base)), raised)];
    return [create("msup", create("mi", base.name), raised), ...this.setArgument(base.argument)];
  }

  /** @param {Product} product */
  setProduct({ factors, signs }) {
    return factors.flatMap((factor, k) => {
      if (k === 0 || signs[k] === "(") return this.setNode(factor);
      return [signs[k] ? createOperator(signs[k]) : createGap(), ...this.setNode(factor)];
    });
  }

  /** @param {Quotient} quotient */
  setQuotient({ over, under }) {
    if (this.isStacked) return [create("mfrac", this.setPart(over), this.setPart(under))];
    return [...this.setNode(over), createWith("mo", TIGHT, "/"), ...this.setNode(under)];
  }

  /** What stands over or under a line needs no brackets. @param {Node_} node */
  setPart(node) {
    return join(node.kind === "group" ? this.setTerms(node.terms) : this.setNode(node));
  }
}

/** Whether a fraction is more than a symbol by a symbol, as in Mgl/p_psi. @param {Node_} node @returns {boolean} */
const hasFraction = (node) => {
  if (node.kind === "quotient")
    return [node.over, node.under].some(({ kind }) => kind === "product" || kind === "group");
  if (node.kind === "product") return node.factors.some(hasFraction);
  return node.kind === "negative" && hasFraction(node.of);
};

/**
 * A formula, of which a line may break between its terms; on lines of its own if it is an equation
 * with fractions. A screen reader says it in words.
 * @param {Term[]} terms @param {string} before on the same line @param {string} after
 */
const createFormula = (terms, before, after) => {
  const isEquation = terms.some(({ sign }) => /[=<>]/.test(sign));
  const isStacked = isEquation && terms.some(({ node }) => hasFraction(node));
  const setter = new Setter(isStacked);
  const style = { displaystyle: String(isStacked) };
  const pieces = terms.map((term) => createWith("math", style, ...setter.setTerms([term])));
  if (before) pieces[0].prepend(create("mtext", before));
  if (after) pieces[pieces.length - 1].append(create("mtext", after));
  const formula = document.createElement("span");
  const isLong = terms.length > UNBROKEN;
  formula.className = isStacked ? "formula own" : isLong ? "formula long" : "formula";
  formula.setAttribute("role", "img");
  formula.ariaLabel = before + speakFormula(terms) + after;
  formula.append(...pieces.flatMap((piece, k) => (k ? ["\u200b", piece] : [piece])));
  return formula;
};

/** Signs of a sentence, which texts have in ASCII. @param {string} text */
const setProse = (text) =>
  text
    .replaceAll("->", "\u2192")
    .replace(/(\d)e([+-]?)0*(\d+)(?![\p{L}\d])/gu, (_, digit, sign, size) => {
      const exponent = raise(sign === "-" ? `-${size}` : size);
      return `${digit}\u00b710${exponent}`;
    })
    .replace(/(?<=[\p{L}\d])\^(-?\d+)/gu, (_, exponent) => raise(exponent))
    .replace(/(?<![\p{L}\d])-(?=\d)/gu, SIGNS["-"]);

const QUANTITY =
  /([\u2212\d.,]*\d (?:rad\/s\u00b2|rad\/s|rad|kg m\u00b2|N m s|N m|mJ|J|1\/s\u00b2|1\/s|ms|mm|cm|m|s|Hz)(?![\p{L}\d/]))/u;

/** A number stays on the line of its unit. @param {string} text @returns {(Node | string)[]} */
const holdUnits = (text) =>
  text.split(QUANTITY).map((part, k) => {
    if (k % 2 === 0) return part;
    const quantity = document.createElement("span");
    quantity.className = "quantity";
    quantity.textContent = part;
    return quantity;
  });

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

const COMMAND = /`([^`]+)`/;

/** What is typed in a terminal. @param {string} text */
const createCommand = (text) => {
  const command = document.createElement("code");
  command.textContent = text;
  return command;
};

/**
 * The parts of a text: its formulas, the words that name an arrow, [torque|torque], and commands
 * between backquotes.
 * @param {string} text @returns {(Node | string)[]}
 */
export const typeset = (text) =>
  text.split(COMMAND).flatMap((part, k) => (k % 2 ? [createCommand(part)] : typesetWords(part)));

/** @param {string} text @returns {(Node | string)[]} */
const typesetWords = (text) => {
  const parts = text.split(WORD);
  return parts.flatMap((part, k) => {
    if (k % 3 === 2) return [];
    return k % 3 ? [createWord(part, parts[k + 1])] : typesetSymbols(part);
  });
};

/**
 * A formula on lines of its own ends its line.
 * @param {Node | string} part @param {Node | string | undefined} before
 */
const endParagraph = (part, before) => {
  const isAfterOwn = before instanceof HTMLElement && before.classList.contains("own");
  return isAfterOwn && typeof part === "string" ? part.replace(/^ ?\n?/, "") : part;
};

/** The parts of a text, with its formulas. @param {string} text @returns {(Node | string)[]} */
export const typesetSymbols = (text) => {
  const parts = findFormulas(text);
  const set = parts.map(({ text, terms }, k) => {
    const [before, after] = [parts[k - 1]?.text ?? "", parts[k + 1]?.text ?? ""];
    if (terms) {
      const [opening = ""] = before.match(OPENING) ?? [];
      const [closing = ""] = after.match(CLOSING) ?? [];
      return createFormula(terms, opening, closing);
    }
    const own = k > 0 ? text.replace(CLOSING, "") : text;
    return setProse(k < parts.length - 1 ? own.replace(OPENING, "") : own);
  });
  return set
    .map((part, k) => endParagraph(part, set[k - 1]))
    .flatMap((part) => (typeof part === "string" ? holdUnits(part) : [part]))
    .filter((part) => part !== "");
};
