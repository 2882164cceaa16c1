// Formulas in plain texts, such as "E' = E - p_psi^2/(2 Iz)": where they stand, and what they consist of.

/**
 * What a formula consists of. A derivative of an angle by time has primes, as in texts.
 * @typedef {{kind: "symbol", name: string, index: string, primes: number,
 *   isMarked?: boolean}} Symbol_
 * @typedef {{kind: "number", text: string, unit: string}} Number_
 * @typedef {{kind: "call", name: string, argument: Term[]}} Call
 * @typedef {{kind: "group", terms: Term[]}} Group
 * @typedef {{kind: "power", base: Node_, exponent: string}} Power
 * @typedef {{kind: "negative", of: Node_}} Negative
 * @typedef {{kind: "product", factors: Node_[], signs: string[]}} Product a sign before each factor, or ""
 * @typedef {{kind: "quotient", over: Node_, under: Node_}} Quotient
 * @typedef {Symbol_ | Number_ | Call | Group | Power | Negative | Product | Quotient} Node_
 * @typedef {{sign: string, node: Node_}} Term with the operator or relation before it, or ""
 */

/** Greek letters by their names; those of angles have dots for primes. @type {{[name: string]: string}} */
export const LETTERS = {
  theta: "\u03b8",
  phi: "\u03c6",
  psi: "\u03c8",
  omega: "\u03c9",
  lambda: "\u03bb",
  alpha: "\u03b1",
};
// In every language: no L begins L\u00f6sung, nor l\u2019axe. A letter that is a word somewhere, such as a, u or y,
// is a symbol with an index, a power or next to an operator only.
const SYMBOL =
  /(?<![\p{L}\d_])(theta|phi|psi|omega|lambda|alpha|torque(?=_)|Mgl|dL|dt|Ix|Iy|Iz|p|L|U|u|E|J|z)(?:_(phi|psi|eff|[xyz0]))?('{0,2})(?![\p{L}\d_'\u2019])/uy;
// Where a sentence speaks of such a letter it is marked: $u$.
const MARKED = /\$([uz])\$/y;
const NUMBER = /\d+(?:[.,]\d+)?(?![\p{L}\d\u00b0%])/uy;
const UNIT = / (rad\/s\^2|rad\/s|rad|kg m\^2|N m s|N m|mJ|J|ms|s)(?![\p{L}\d/^])/uy;
const CALL = /(?<![\p{L}\d_])(sin|cos|sqrt)\(/uy;
const POWER = /\^(-?\d+)/y;
const RELATION = / ([=<>]) /y;
const SIGN = / ([+-]) /y;
const CROSSED = / ([x.]) /y;

class Reader {
  /** @param {string} text @param {number} at */
  constructor(text, at) {
    this.text = text;
    this.at = at;
  }

  /** Read what matches here. @param {RegExp} pattern that is sticky */
  match(pattern) {
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text);
    if (found) this.at = pattern.lastIndex;
    return found;
  }

  /** Read something whole, or nothing. @template T @param {() => T | null} read @returns {T | null} */
  attempt(read) {
    const { at } = this;
    const found = read();
    if (!found) this.at = at;
    return found;
  }

  /** Terms, with the sign before each that follows. @param {Term[]} terms */
  readMore(terms) {
    for (;;) {
      const more = this.attempt(() => {
        const found = this.match(SIGN);
        const node = found && this.readTerm();
        return node && { sign: found[1], node };
      });
      if (!more) return terms;
      terms.push(more);
    }
  }

  /** Sums, between which relations stand. @returns {Term[] | null} */
  readRelations() {
    const terms = this.readSum();
    while (terms) {
      const more = this.attempt(() => {
        const found = this.match(RELATION);
        const [first, ...others] = (found && this.readSum()) ?? [];
        return found && first && [{ ...first, sign: found[1] }, ...others];
      });
      if (!more) break;
      terms.push(...more);
    }
    return terms;
  }

  /** @returns {Term[] | null} */
  readSum() {
    const node = this.attempt(() => {
      const isNegative = this.match(/-/y);
      const term = this.readTerm();
      return isNegative && term ? /** @type {Negative} */ ({ kind: "negative", of: term }) : term;
    });
    return node && this.readMore([{ sign: "", node }]);
  }

  /** Products, divided as a whole: a b / (c d). @returns {Node_ | null} */
  readTerm() {
    let term = this.readProduct();
    while (term) {
      const under = this.attempt(() => this.match(/ \/ /y) && this.readProduct());
      if (!under) break;
      term = { kind: "quotient", over: term, under };
    }
    return term;
  }

  /** @returns {Node_ | null} */
  readProduct() {
    const first = this.readPower();
    if (!first || (first.kind === "number" && first.unit)) return first;
    /** @type {Product} */
    let product = { kind: "product", factors: [first], signs: [""] };
    for (;;) {
      const under = this.attempt(() => this.match(/\//y) && this.readPower());
      // a b/c is (a b)/c
      if (under) {
        const over = simplify(product);
        product = {
          kind: "product",
          factors: [{ kind: "quotient", over, under }],
          signs: [""],
        };
        continue;
      }
      const sign = this.attempt(() => this.readFactor(product));
      if (!sign) return simplify(product);
    }
  }

  /** Add a factor to a product; a number begins one. @param {Product} product */
  readFactor(product) {
    const sign = this.match(CROSSED) ?? this.match(/ /y);
    const node = sign && !/\d/.test(this.text[this.at] ?? "") && this.readPower();
    if (!node) return null;
    product.factors.push(node);
    product.signs.push(sign[1] ?? "");
    return sign;
  }

  /** @returns {Node_ | null} */
  readPower() {
    const base = this.readNumber() ?? this.readCall() ?? this.readSymbol() ?? this.readGroup();
    if (!base || (base.kind === "number" && base.unit)) return base;
    const exponent = this.match(POWER)?.[1];
    const power = exponent ? /** @type {Power} */ ({ kind: "power", base, exponent }) : base;
    if (base.kind !== "number") return power;
    return base.text === "10" || !exponent ? power : null;
  }

  /** @returns {Number_ | null} */
  readNumber() {
    const [text] = this.match(NUMBER) ?? [];
    return text ? { kind: "number", text, unit: this.match(UNIT)?.[1] ?? "" } : null;
  }

  /** @returns {Call | null} */
  readCall() {
    return this.attempt(() => {
      const found = this.match(CALL);
      const argument = found && this.readSum();
      return argument && this.match(/\)/y) && { kind: "call", name: found[1], argument };
    });
  }

  /** A symbol, or a function of that name. @returns {Node_ | null} */
  readSymbol() {
    const [, marked] = this.match(MARKED) ?? [];
    if (marked) return { kind: "symbol", name: marked, index: "", primes: 0, isMarked: true };
    const [, name, index = "", { length: primes } = ""] = this.match(SYMBOL) ?? [];
    if (!name) return null;
    /** @type {Node_} */
    const symbol = { kind: "symbol", name, index, primes };
    const group = this.text[this.at] === "(" ? this.readGroup() : null;
    return group ? { kind: "product", factors: [symbol, group], signs: ["", "("] } : symbol;
  }

  /** @returns {Group | null} */
  readGroup() {
    return this.attempt(() => {
      const terms = this.match(/\(/y) && this.readSum();
      return terms && this.match(/\)/y) && { kind: "group", terms };
    });
  }
}

/** @param {Product} product @returns {Node_} */
const simplify = (product) => (product.factors.length === 1 ? product.factors[0] : product);

/** Whether a symbol alone is one, and not a word of one letter. @param {Symbol_} symbol */
const isSymbol = ({ name, index, primes, isMarked }) =>
  isMarked ||
  name === "L" ||
  index !== "" ||
  (name.length > 1 ? name !== "dt" : primes > 0 && /[Ez]/.test(name));

/** Whether there is a symbol or a power in a part of a formula. @param {Node_} node @returns {boolean} */
const hasSymbol = (node) => {
  switch (node.kind) {
    case "symbol":
    case "power":
    case "call":
      return true;
    case "number":
      return false;
    case "negative":
      return hasSymbol(node.of);
    case "group":
      return node.terms.some((term) => hasSymbol(term.node));
    case "product":
      return node.factors.some(hasSymbol);
    case "quotient":
      return hasSymbol(node.over) || hasSymbol(node.under);
  }
};

/** Whether terms are a formula, and no number or word of a sentence. @param {Term[]} terms */
const isFormula = (terms) => {
  const [{ node }, ...others] = terms;
  if (others.length) return terms.some((term) => hasSymbol(term.node) || /[=<>]/.test(term.sign));
  if (node.kind === "symbol") return isSymbol(node);
  return node.kind !== "group" && hasSymbol(node);
};

const BEGIN = /(?<![\p{L}\d_.,'\u2019])[\p{L}\d($-]/gu;

/**
 * A text in parts: what is said, and formulas with their terms.
 * @param {string} text @returns {{text: string, terms: Term[] | null}[]}
 */
export const findFormulas = (text) => {
  /** @type {{text: string, terms: Term[] | null}[]} */
  const parts = [];
  let end = 0;
  for (const { index } of text.matchAll(BEGIN)) {
    if (index < end) continue;
    const reader = new Reader(text, index);
    const terms = reader.readRelations();
    if (!terms || !isFormula(terms)) continue;
    parts.push({ text: text.slice(end, index), terms: null });
    parts.push({ text: text.slice(index, reader.at), terms });
    end = reader.at;
  }
  return [...parts, { text: text.slice(end), terms: null }];
};
