// Formulas as they are read aloud, in the language of the page.

import { findFormulas, LETTERS } from "./formula.js";
import { phrase } from "./wording.js";

/** @import { Node_, Symbol_, Term } from "./formula.js" */

/** @type {{[sign: string]: string}} */
const SIGNS = {
  "=": "equal",
  "<": "less",
  ">": "greater",
  "+": "plus",
  "-": "minus",
  x: "cross",
  ".": "dot_product",
};

/** @param {string} key */
const say = (key) => phrase(`spoken.${key}`);

/** A symbol by its letters: p psi, I z, phi with a dot. @param {Symbol_} symbol */
const speakSymbol = ({ name, index, primes }) => {
  const letters = name
    .replace(/^I([xyz])$/, "I $1")
    .replace("Mgl", "M g l")
    .replace(/^d([tL])$/, "d $1");
  const marks = name in LETTERS ? ["", "dot", "two_dots"] : ["", "prime", "two_primes"];
  return [letters, index, primes ? say(marks[primes]) : ""];
};

/** @param {string} exponent */
const speakExponent = (exponent) =>
  exponent === "2" ? say("squared") : phrase("spoken.power", { exponent });

/** Words, and "" for what has none. @param {Node_} node @returns {string[]} */
const speakNode = (node) => {
  switch (node.kind) {
    case "symbol":
      return speakSymbol(node);
    case "number":
      return [node.text, node.unit.replace("^2", "\u00b2")];
    case "call":
      return [
        say(node.name),
        ...speakTerms(node.argument),
        node.argument.length > 1 ? say("end") : "",
      ];
    case "group":
      return [say("open"), ...speakTerms(node.terms), say("close")];
    case "power":
      return [...speakNode(node.base), speakExponent(node.exponent)];
    case "negative":
      return [say("minus"), ...speakNode(node.of)];
    case "product":
      return node.factors.flatMap((factor, k) => [
        node.signs[k] in SIGNS ? say(SIGNS[node.signs[k]]) : "",
        ...speakNode(factor),
      ]);
    case "quotient":
      return [...speakNode(node.over), say("over"), ...speakNode(node.under)];
  }
};

/** @param {Term[]} terms */
const speakTerms = (terms) =>
  terms.flatMap(({ sign, node }) => [sign ? say(SIGNS[sign]) : "", ...speakNode(node)]);

/** A formula in words. @param {Term[]} terms */
export const speakFormula = (terms) => speakTerms(terms).filter(Boolean).join(" ");

/** A text whose formulas are in words, for a label that a screen reader alone has. @param {string} text */
export const speakText = (text) =>
  findFormulas(text)
    .map(({ text, terms }) => (terms ? speakFormula(terms) : text))
    .join("");
