"""Look for missing and wrong texts of a language: `make -C workshop language ARGS=de`."""

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from symtop_ros.page.web.join import TERMS, TEXTS, read_file, read_texts
from symtop_ros.words.templates import FOLDER as WORDING
from symtop_ros.words.templates import PLACEHOLDER, read_templates

# What must be the same in every language: placeholders, arrows of the scene, symbols, numbers.
ARROW = re.compile(r"\[[^|\]]+\|([^|\]]+)\]")
SYMBOL = re.compile(
    r"\b(?:theta|phi|psi|omega|lambda|p_phi|p_psi|U_eff|Mgl|Ix|Iz)\b'{0,2}|\brad/s\b|\bmJ\b"
)
NUMBER = re.compile(r"(?<![\w{:^_])\d+(?:[.,]\d+)?")
SCENE = re.compile(r"scene\.\w+\.(?:title|story)")
PLURAL = re.compile(r"\.(?:zero|one|two|few|many)$")  # forms that English does not have
GLUED = re.compile(r"\}['\u2019]?[^\W\d_]")  # a suffix of a language at a number or a symbol


def find_faults(language: str) -> Iterator[str]:
    """Yield what is wrong in the files of a language, compared with the English texts."""
    files = [folder / f"{language}.json" for folder in (WORDING, TEXTS)]
    if missing := [path for path in files if not path.exists()]:
        yield from (f"{path.parent.name}/{path.name}: is missing" for path in missing)
        return
    yield from _compare_keys(read_templates("en"), read_templates(language))
    yield from _compare_keys(_read_terms("en"), _read_terms(language))
    english = read_texts("en")
    texts = read_texts(language)
    # English titles and stories of scenes are those of their files.
    scenes = {key: text for key, text in english.items() if SCENE.fullmatch(key)}
    yield from _compare_keys(
        read_file("en") | (scenes if language != "en" else {}), read_file(language)
    )
    for key in english.keys() & texts.keys():
        yield from (f"{key}: {fault}" for fault in compare_texts(english[key], texts[key]))


def _compare_keys(english: Mapping[str, str], texts: Mapping[str, str]) -> Iterator[str]:
    yield from (f"{key}: is missing" for key in english.keys() - texts.keys())
    more = {key for key in texts.keys() - english.keys() if PLURAL.sub("", key) not in english}
    yield from (f"{key}: is no key" for key in more)
    yield from (f"{key}: is empty" for key in texts if english.get(key) and not texts[key].strip())


def _read_terms(language: str) -> dict[str, str]:
    text = (TEXTS / f"{language}.json").read_text(encoding="utf-8")
    terms: dict[str, str] = json.loads(text)[TERMS]
    return terms


def compare_texts(english: str, text: str) -> Iterator[str]:
    """Yield what a text lacks of the English one, or has too much."""
    for name, pattern in (("arrow", ARROW), ("symbol", SYMBOL)):
        yield from _compare_parts(name, pattern.findall(english), pattern.findall(text))
    parts = [["".join(each) for each in PLACEHOLDER.findall(one)] for one in (english, text)]
    yield from _compare_parts("placeholder", *parts)
    plain = [NUMBER.findall(PLACEHOLDER.sub("", one)) for one in (english, text)]
    numbers = [[each.replace(",", ".") for each in one] for one in plain]
    yield from _compare_parts("number", *numbers)
    if GLUED.search(text):
        yield "a number must have no suffix"
    if "'" in SYMBOL.sub("", re.sub(r"\b[EL]_?z?'", "", text)) and "'" not in english:
        yield "an apostrophe must be U+2019: ' is a derivative"


def _compare_parts(name: str, english: list[str], text: list[str]) -> Iterator[str]:
    missing, more = Counter(english) - Counter(text), Counter(text) - Counter(english)
    yield from (f"{name} {each} is missing" for each in missing)
    yield from (f"{name} {each} is not in the English text" for each in more)


def check_languages(languages: Sequence[str]) -> int:
    """Print what is wrong; return 0 if nothing is."""
    faults = [f"{each}: {fault}" for each in languages for fault in find_faults(each)]
    print("\n".join(faults) or "complete")
    return 1 if faults else 0
