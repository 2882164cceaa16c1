"""The reference, written from docs/derivation.md alone, and the kernel are the same."""

import re
from pathlib import Path

import pytest

from symtop_ros.physics.reference import closed_form

pytestmark = pytest.mark.untraced
PAGE = Path(__file__).parents[2] / "docs/derivation.md"


def test_what_the_derivation_quotes_is_the_code_of_the_reference():
    code = dedent_lines(Path(closed_form.__file__).read_text())
    quoted = re.findall(r"^```py\n(.+?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert len(quoted) == 6
    for each in quoted:
        assert dedent_lines(each) in code


def dedent_lines(text):
    return "\n".join(line.strip() for line in text.splitlines())
