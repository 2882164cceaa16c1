"""Coefficients of friction are the same ones in every place that has a list of them."""

import json
import re
from dataclasses import fields
from pathlib import Path

from physics.tops import ARTICLE, CUSPS

import symtop_ros
from symtop_ros.physics import Friction, Motion
from symtop_ros.simulation.events import MOTION
from symtop_ros.simulation.run_file import TABLE
from symtop_ros.simulation.settings import PARAMETERS, list_body

PACKAGE = Path(symtop_ros.__file__).parent
COEFFICIENTS = [field.name for field in fields(Friction)]
MOVING = Motion(ARTICLE, CUSPS)


def read(*names):
    return PACKAGE.joinpath(*names).read_text(encoding="utf-8")


def list_named(text):
    return re.findall(r'"friction\.(\w+)"', text)


def count_in_c():
    return int(re.search(r"double friction\[(\d+)\]", read("physics", "kernel", "symtop.h"))[1])


def find_places_without(names):
    """The places that do not have just these coefficients."""
    named = {
        "settings": list_named(json.dumps(list(PARAMETERS))),
        "what parameters make of a motion": list_named(json.dumps(list_body(MOVING))),
        "fields of the page": list_named(read("web", "js", "controls", "fields.js")),
        "what the page asks of a node": list_named(read("web", "js", "physics", "course.js")),
    }
    counted = {
        "C": count_in_c(),
        "events": len(MOTION["friction"](MOVING)),
        "run.json": TABLE["event"]["friction"]["size"],
    }
    found = {place for place, each in named.items() if each != names}
    return found | {place for place, count in counted.items() if count != len(names)}


def test_every_place_has_the_coefficients_of_friction():
    assert find_places_without(COEFFICIENTS) == set()
