"""What sentences of five languages say of up and down, by the table `directions.yaml`.

A reader without the labels of the parts takes each verb by itself. So a verb has one meaning, which
is a quantity: where the axis moves now, which way it accelerates, what its highest and its lowest
point are compared with no push, and what the mean height is.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

TABLE: dict[str, dict[str, Any]] = yaml.safe_load(
    Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
)
NUMBER = r"[\d.,e+-]+(?: rad|°)"
OPPOSITE = (("axis", "mass"), ("mean", "mean_mass"))


def read_facts(language: str, text: str) -> Iterator[tuple[str, int]]:
    """Yield each quantity that a text speaks of, and its way; fail at a word of no phrase."""
    words = TABLE[language]
    left = re.sub(words["neutral"], "", text)
    for phrase in words["phrases"]:
        form = re.sub(r"\bN\b", lambda _: NUMBER, phrase)
        for found in re.finditer(form, left):
            said = {name: word for name, word in found.groupdict().items() if word}
            yield from (read_fact(words, name, word) for name, word in said.items())
        left = re.sub(form, "#", left)
    word = re.search(words["stems"], left)
    assert not word, f"{word[0]!r} is of no phrase in {left!r}"


def read_fact(words: dict[str, Any], name: str, word: str) -> tuple[str, int]:
    """Return a quantity and its way, 1 for up or higher, by the name of a group and its word."""
    kind, _, point = name.partition("_")
    if kind == "no":  # a highest point that is no longer reached is lower than it was
        return point, -1 if point == "highest" else 1
    if kind == "to":
        return point, words["further"][word] * (1 if point == "highest" else -1)
    return name, words["ways"].get(word, 0)


def find_contradictions(facts: list[tuple[str, int]]) -> list[str]:
    """Return the quantities that are said to go two ways."""
    said: dict[str, set[int]] = {}
    for name, way in facts:
        said.setdefault(name, set()).add(way)
    found = [name for name, ways in said.items() if len(ways) > 1]
    for one, other in OPPOSITE:
        if one in said and other in said and said[one] != {-way for way in said[other]}:
            found.append(f"{one} and {other}")
    return found
