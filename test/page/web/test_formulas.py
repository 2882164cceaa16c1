"""Formulas of the page's texts: found in every language, and set as what the text says."""

import math
import re
from xml.etree import ElementTree

import pytest
from page.web.modules import load_kernel

from symtop_ros.page.web.join import LANGUAGES, read_texts
from workshop import borrowed

GREEK = {"θ": "theta", "φ": "phi", "ψ": "psi", "ω": "omega", "λ": "lambda", "\u03b1": "alpha"}
UNITS = {"rad/s²": 3.0, "rad/s": 5.0, "rad": 7.0, "kg m²": 11.0, "N m s": 13.0, "N m": 17.0}
UNITS |= {"mJ": 19.0, "J": 23.0, "ms": 29.0, "s": 31.0}
# What a text has of a formula in ASCII, and a sentence has not.
ASCII = re.compile(
    r"\^|\b(theta|phi|psi|omega|lambda|Ix|Iz|Mgl)\b|_(phi|psi|eff)|\w'(?!\w)|->|sqrt"
)
# Names of the code and of columns stay in ASCII.
CODE = re.compile(r"`[^`]*`|\w+_dot|\{[^}]*\}")


@pytest.fixture(scope="module")
def set_texts(tab):
    """A function that sets the texts of a language; of each it returns prose and formulas."""
    found = {}

    def set_all(language):
        if language not in found:
            texts = {k: v for k, v in read_texts(language).items() if isinstance(v, str)}
            load_kernel(tab, language)
            set_ = tab.evaluate("setTexts", list(texts.values()))
            found[language] = dict(zip(texts, set_, strict=True))
        return found[language]

    yield set_all
    load_kernel(tab)


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_sign_of_a_formula_is_left_in_a_sentence(set_texts, language):
    left = {
        (key, text)
        for key, found in set_texts(language).items()
        for text in found["prose"]
        if ASCII.search(CODE.sub("", text))
    }
    assert left == set()


@pytest.mark.parametrize("language", [each for each in LANGUAGES if each != "en"])
def test_a_text_has_the_same_equations_in_every_language(set_texts, language):
    def list_trees(found):
        trees = [formula["tree"] for formula in found["formulas"]]
        return sorted(
            re.sub(r"(\d),(\d)", r"\1.\2", each) for each in trees if '"sign":"="' in each
        )

    english = set_texts("en")
    for key, found in set_texts(language).items():
        if key in english:
            assert list_trees(found) == list_trees(english[key]), key


def test_a_formula_means_what_its_text_says(set_texts):
    """Each is read back from the MathML, and from the text; at some values both are the same.

    Both take the same operations in another order, some dozens, each rounded to an EPS.
    """
    formulas = [each for found in set_texts("en").values() for each in found["formulas"]]
    assert sum("=" in each["source"] for each in formulas) >= 60
    for each in formulas:
        shown, meant = read_math(each["pieces"]), read_text(each["source"])
        assert re.findall("[=<>]", shown) == re.findall("[=<>]", meant), each["source"]
        sides = [re.split("[=<>]", text) for text in (shown, meant)]
        for one, other in zip(*sides, strict=True):
            assert calculate(one) == pytest.approx(calculate(other), rel=1e-13), each["source"]


def test_an_equation_with_fractions_stands_on_lines_of_its_own(set_texts):
    formulas = [each for found in set_texts("en").values() for each in found["formulas"]]
    for each in formulas:
        is_stacked = any("<mfrac" in piece for piece in each["pieces"])
        assert ("own" in each["name"]) == is_stacked
        compound = re.search(r"/ ?\(|\)/|\^2/2|\) / ", each["source"])
        if "=" in each["source"] and compound:
            assert is_stacked, each["source"]
        if not re.search("[=<>]", each["source"]):
            assert not is_stacked, each["source"]


def test_a_formula_is_read_aloud_in_words(set_texts):
    words = {
        each["source"]: each["words"] for f in set_texts("en").values() for each in f["formulas"]
    }
    said = words["E' = E - p_psi^2/(2 Iz)"].rstrip(".,:")
    assert said == "E prime equals E minus p psi squared over open bracket 2 I z close bracket"
    assert words["theta''"].rstrip(".,:;)").lstrip("(") == "theta double dot"
    for found in set_texts("de").values():
        for each in found["formulas"]:
            assert not re.search(r"[_^'=<>]|equals|squared", each["words"]), each["words"]


def read_math(pieces):
    """Return MathML as an expression of Python."""
    return "".join(multiply(list_tokens(ElementTree.fromstring(piece))) for piece in pieces)


def list_tokens(element):
    """Return the operands, operators and names of functions of an element, in their order."""
    return [token for child in element for token in read_element(child)]


def read_element(element):
    """Return what an element stands for; the power of a function as a pair with its name."""
    if not len(element):
        return read_leaf(element.tag, (element.text or "").replace("\u2009", " "))
    if element.tag in ("mrow", "math", "msqrt"):
        return read_row(element)
    parts = [multiply(read_element(child)) for child in element]
    if element.tag == "mover":
        return [parts[0] + {"\u02d9": "_dot", "\u00a8": "_ddot"}[element[1].text]]
    if element.tag == "msup" and parts[0] in FUNCTIONS:
        return [(parts[0], parts[1])]
    parts[0] = parts[0].strip("()") if "sub" in element.tag else parts[0]  # of d L it is that of L
    return [SHAPES[element.tag].format(*parts)]


def read_row(element):
    tokens = list_tokens(element)
    if element.tag == "msqrt":
        return [f"sqrt({multiply(tokens)})"]
    is_name = len(tokens) > 1 and all(child.tag == "mi" for child in element)  # M g l, d t
    return [f"({'*'.join(tokens)})"] if is_name else tokens


def read_leaf(tag, text):
    if tag == "mspace":
        return [" "]
    if tag == "mtext":  # else a bracket or a full stop of the sentence
        return [repr(UNITS[text])] if text in UNITS else []
    if tag == "mi":
        return [GREEK.get(text, text)]
    return [text.replace("\u2212", "-") if tag == "mn" else SIGNS.get(text, text)]


SHAPES = {"msub": "{0}_{1}", "msup": "({0})**({1})", "msubsup": "({0}_{1})**({2})"}
SHAPES |= {"mfrac": "(({0})/({1}))"}
FUNCTIONS = "sin", "cos"
PRIMES = {"\u2032": "_prime", "\u2033": "_double_prime"}
SIGNS = {**PRIMES, "\u2212": "-", "\u00d7": "*cross*", "\u00b7": "*dot*"}


def multiply(tokens):
    """Return tokens as one expression, with the signs of products that a reader adds."""
    text = ""
    pending = None  # the power of a function whose argument follows
    for token in tokens:
        if token in PRIMES.values():
            text += token
        elif token in FUNCTIONS or isinstance(token, tuple):
            name, pending = token if isinstance(token, tuple) else (token, None)
            text = begin_factor(text) + name
        elif token == " ":
            text += " "
        elif re.search(r"(sin|cos) $", text):
            text = f"{text.rstrip()}({token})" + (f"**{pending}" if pending else "")
            pending = None
        elif token == ")":
            text += token + (f"**{pending}" if pending and is_end_of_call(text) else "")
        else:
            is_operand = re.match(r"[\w(]", token) and not re.search(r"(?<!\w)(sin|cos)$", text)
            is_call = token == "(" and re.search(r"\w$", text)
            text = (begin_factor(text) if is_operand and not is_call else text) + token
    return text


def is_end_of_call(text):
    """Return True if the bracket that is closed next is that of a function."""
    depth = 0
    for k in range(len(text) - 1, -1, -1):
        depth += {")": 1, "(": -1}.get(text[k], 0)
        if depth < 0:
            return bool(re.search(r"(sin|cos)$", text[:k]))
    return False


def begin_factor(text):
    """Return a text to which a factor can be added."""
    return f"{text.rstrip()}*" if re.search(r"[\w)] *$", text) else text


def read_text(text):
    """Return a formula of a text as an expression of Python."""
    units = "|".join(re.escape(each.replace("²", "^2")) for each in UNITS)
    number = re.compile(rf"(\d) ({units})(?![\w/^])")
    text = text.replace("$", "")  # of a letter in a sentence
    text = number.sub(lambda m: f"{m[1]}*{UNITS[m[2].replace('^2', '²')]}", text)
    text = text.replace(" x ", "*cross*").replace(" . ", "*dot*").replace("^", "**")
    greek = "|".join(GREEK.values())
    text = re.sub(rf"\b({greek})''", r"\1_ddot", text)
    text = re.sub(rf"\b({greek})'", r"\1_dot", text)
    text = re.sub(r"\b(\w+)'", r"\1_prime", text)
    text = re.sub(r"\bI([xyz])\b", r"I_\1", text)
    text = text.replace("Mgl", "(M*g*l)").replace("dL", "d*L").replace("dt", "(d*t)")
    return re.sub(r"(?<=[\w)]) (?=[\w(])", "*", text.replace(" / ", "/"))


def calculate(text):
    """Return the value of an expression, with a fixed number for each name."""
    names = {each: 1 + sum(map(ord, each)) % 97 / 100 for each in re.findall(r"[a-zA-Z]\w*", text)}
    names |= {"sin": math.sin, "cos": math.cos, "sqrt": math.sqrt}
    names |= {"well": lambda theta: 2 + theta, "lambda_": 1.7}
    return eval(text.replace("lambda", "lambda_").replace("U_eff(", "well("), names)


def test_the_page_has_the_letters_of_its_formulas(open_page):
    """A letter that the font has is as wide before any other font."""
    page = open_page("#lesson=3")
    measure = """(letters) => {
        const context = document.createElement("canvas").getContext("2d");
        const width = (font, letter) => {
            context.font = `100px symbols, ${font}`;
            return context.measureText(letter).width;
        };
        return letters.filter((each) => width("monospace", each) !== width("serif", each));
    }"""
    page.tab.evaluate("document.fonts.load('100px symbols')")
    assert page.tab.evaluate(measure, sorted(set(borrowed.list_letters()))) == []
    shown = "".join(page.tab.locator("math").all_text_contents())
    assert len(shown) > 100
    assert set(shown) <= {*borrowed.list_letters()}
