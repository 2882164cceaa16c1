"""The examples of docstrings run and print what they say."""

import doctest
import importlib
from pathlib import Path

import pytest

import symtop_ros

PACKAGE = Path(symtop_ros.__file__).parent
NAMES = sorted(
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    for path in PACKAGE.rglob("*.py")
    if "\n    >>> " in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", NAMES)
def test_the_examples_of_a_module_print_what_they_say(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    failed, tried = doctest.testmod(importlib.import_module(name), raise_on_error=False)
    assert not failed
    if not tried:
        pytest.skip("all of its examples need a GPU")
