"""POSIX extended regular expressions, matched in a time that is linear in pattern times text.

Python's `re` tries one way after the other: `'.?' * 60 + 'z'` takes it years, in which no other
thread of the program has a turn. Here an automaton follows all ways together. What POSIX leaves
undefined is refused.
"""

import string

from symtop_ros.node.automaton import (
    Anchor,
    Automaton,
    Character,
    Choice,
    Node,
    Repeat,
    Sequel,
    Test,
)

MAX_LENGTH = 20_000  # characters of a pattern
MAX_GROUPS = 100  # one in another
MAX_COUNT = 255  # of repetitions, {m,n}: RE_DUP_MAX of POSIX
MAX_WORK = 50_000  # states times places in the text: some hundredths of a second
SPECIAL = ".[]()*+?{}|^$\\"

CLASSES: dict[str, Test] = {
    "alnum": str.isalnum,
    "alpha": str.isalpha,
    "blank": lambda each: each in " \t",
    "cntrl": lambda each: ord(each) < 32 or ord(each) == 127,
    "digit": lambda each: each in string.digits,
    "graph": lambda each: each.isprintable() and not each.isspace(),
    "lower": str.islower,
    "print": str.isprintable,
    "punct": lambda each: each in string.punctuation,
    "space": str.isspace,
    "upper": str.isupper,
    "xdigit": lambda each: each in string.hexdigits,
}


class ExpressionError(ValueError):
    """A pattern that is refused; the text says what is wrong in it."""


def search(pattern: str, text: str) -> bool:
    """Return True if a pattern matches somewhere in a text.

    Raises
    ------
    ExpressionError
        If the pattern is no extended regular expression, or too long for this text.

    Examples
    --------
    >>> search("^t(o|i)p[[:digit:]]{1,2}$", "top12")
    True
    """
    if len(pattern) > MAX_LENGTH:
        raise ExpressionError(f"it is longer than {MAX_LENGTH} characters")
    node = _Parser(pattern).parse()
    if (node.size + 1) * (len(text) + 1) > MAX_WORK:
        raise ExpressionError(f"it has too many parts, {node.size} with repetitions written out")
    return Automaton(node).search(text)


class _Parser:
    """Reads a pattern from its begin to its end."""

    def __init__(self, pattern: str) -> None:
        self._pattern, self._place, self._depth = pattern, 0, 0

    def parse(self) -> Node:
        """Return the whole pattern."""
        node = self._read_choice()
        if self._next:  # read up to a parenthesis
            raise ExpressionError(f"the ) at character {self._place + 1} closes no (")
        return node

    @property
    def _next(self) -> str:
        return self._pattern[self._place : self._place + 1]

    def _take(self) -> str:
        self._place += 1
        return self._pattern[self._place - 1]

    def _read_choice(self) -> Node:
        parts = [self._read_sequel()]
        while self._next == "|":
            self._place += 1
            parts.append(self._read_sequel())
        return parts[0] if len(parts) == 1 else Choice(parts, 1 + sum(each.size for each in parts))

    def _read_sequel(self) -> Node:
        parts: list[Node] = []
        while self._next not in ("", "|", ")"):
            parts.append(self._read_repeated())
        return Sequel(parts)

    def _read_repeated(self) -> Node:
        part = self._read_one()
        if not self._next or self._next not in "*+?{":
            return part
        if isinstance(part, Anchor):
            raise ExpressionError(f"{part.place} cannot be repeated")
        least, most = self._read_count()
        if self._next and self._next in "*+?{":
            raise ExpressionError(f"{self._next} repeats a repetition: use a group")
        copies = least + 1 if most is None else most
        return Repeat(part, least, most, copies * (part.size + 1))

    def _read_count(self) -> tuple[int, int | None]:
        kind = self._take()
        if kind != "{":
            return (1 if kind == "+" else 0), (1 if kind == "?" else None)
        end = self._pattern.find("}", self._place)
        low, comma, high = self._pattern[self._place : max(end, self._place)].partition(",")
        texts = [low, high] if high else [low]
        if not all(each.isascii() and each.isdigit() and len(each) <= 3 for each in texts):
            raise ExpressionError("{ must be followed by {m}, {m,} or {m,n} with up to 3 digits")
        self._place = end + 1
        least, most = int(low), int(high or low) if high or not comma else None
        if max(least, most or 0) > MAX_COUNT or (most is not None and most < least):
            raise ExpressionError(f"a repetition must be 0 to {MAX_COUNT} times, the least first")
        return least, most

    def _read_one(self) -> Node:
        letter = self._take()
        if letter in "*+?{":
            raise ExpressionError(f"{letter} repeats nothing")
        if letter in "^$":
            return Anchor("^" if letter == "^" else "$")
        if letter == "(":
            return self._read_group()
        if letter == "[":
            return Character(self._read_bracket())
        if letter == ".":
            return Character(lambda _: True)
        return Character((self._read_escaped() if letter == "\\" else letter).__eq__)

    def _read_group(self) -> Node:
        self._depth += 1
        if self._depth > MAX_GROUPS:
            raise ExpressionError(f"more than {MAX_GROUPS} groups are in each other")
        node = self._read_choice()
        if not self._next:
            raise ExpressionError("a ( is not closed")
        self._place += 1
        self._depth -= 1
        return node

    def _read_escaped(self) -> str:
        letter = self._next
        if not letter or letter not in SPECIAL:
            raise ExpressionError(
                f"\\{letter} has no meaning in POSIX: use a class such as [[:digit:]]"
            )
        return self._take()

    def _read_bracket(self) -> Test:
        """Return the test of a bracket expression, after its [."""
        is_inverted = self._next == "^"
        self._place += is_inverted
        begin, tests = self._place, list[Test]()
        while self._place == begin or self._next != "]":
            tests.append(self._read_member())
        self._place += 1
        return lambda each: any(test(each) for test in tests) != is_inverted

    def _read_member(self) -> Test:
        """Return the test of a class, a range or one character in brackets."""
        if self._pattern.startswith("[:", self._place):
            name = self._read_delimited(":")
            if name not in CLASSES:
                raise ExpressionError(f"[:{name[:20]}:] is no class: {', '.join(CLASSES)}")
            return CLASSES[name]
        low = high = self._read_end()
        if self._next == "-" and not self._pattern.startswith("-]", self._place):
            self._place += 1
            high = self._read_end()
        if high < low:
            raise ExpressionError(f"the range {low}-{high} is empty")
        return lambda each: low <= each <= high

    def _read_end(self) -> str:
        """Return a character, or the one of [.x.] or [=x=]."""
        for kind in (".", "="):
            if self._pattern.startswith(f"[{kind}", self._place):
                element = self._read_delimited(kind)
                if len(element) != 1:
                    raise ExpressionError(f"[{kind} must be followed by one character")
                return element
        if not self._next:
            raise ExpressionError("a [ is not closed")
        return self._take()

    def _read_delimited(self, kind: str) -> str:
        begin = self._place + 2
        end = self._pattern.find(f"{kind}]", begin)
        if end < 0:
            raise ExpressionError(f"a [{kind} is not closed")
        self._place = end + 2
        return self._pattern[begin:end]
