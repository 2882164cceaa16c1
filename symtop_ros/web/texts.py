"""All texts of the page and of the lesson, in each language."""

import functools
import json
from pathlib import Path

from symtop_ros.simulation.presets import describe_scenes
from symtop_ros.wording.templates import read_templates

FOLDER = Path(__file__).with_name("texts")
LANGUAGES = tuple(sorted(path.stem for path in FOLDER.glob("*.json")))
TERMS = "terms"  # those of the textbooks of a language, for its translators


def read_file(language: str) -> dict[str, str]:
    """Return the texts of a language that no record makes, by their keys."""
    text = (FOLDER / f"{language}.json").read_text(encoding="utf-8")
    return {key: value for key, value in json.loads(text).items() if key != TERMS}


@functools.cache
def read_texts(language: str) -> dict[str, str]:
    """Return all texts of a language; a scene that it does not know has its English story."""
    texts: dict[str, str] = {}
    for name, title, story in describe_scenes():
        texts |= {f"scene.{name}.title": title, f"scene.{name}.story": story}
    return texts | read_templates(language) | read_file(language)
