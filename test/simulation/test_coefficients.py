"""Coefficients of friction on the page, whose lists are its own, are those of the library."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

import symtop_ros
from symtop_ros.physics import Friction

MODULES = Path(symtop_ros.__file__).parent / "web" / "js"


@pytest.mark.parametrize("name", ["controls/fields.js", "physics/course.js"])
def test_the_page_has_the_coefficients_of_friction(name):
    named = re.findall(r'"friction\.(\w+)"', (MODULES / name).read_text(encoding="utf-8"))
    assert named == [field.name for field in fields(Friction)]
