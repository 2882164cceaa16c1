"""docs/top.html is the page of the newest release: it says so, opens and computes."""

import math
import re

import pytest
from documents import ROOT
from test_release import CHANGELOG, SECTION

PAGE = ROOT / "docs/top.html"
VERSION = re.compile(r'<meta name="generator" content="symtop_ros ([^"]+)">')


def test_it_is_of_the_newest_release_of_the_changelog():
    sections = SECTION.findall(CHANGELOG.read_text(encoding="utf-8"))
    newest = next(each.partition(" ")[0] for each in sections if each != "Forthcoming")
    assert VERSION.findall(PAGE.read_text(encoding="utf-8")) == [newest]


def test_it_opens_and_computes(open_page):
    tab = open_page("#scene=hurry_slow", file=PAGE).tab
    top = "{Ix: 0.000228, Iz: 0.0000572, Mgl: 0.068, orientation: [0.8, 0.6, 0, 0], "
    motion = f"window.symtop.motion({top}angular_velocity: [0, 0, 200]}})"
    assert tab.evaluate(f"{motion}.kind") == "cusps"
    low, high = tab.evaluate(f"{motion}.turning_angles")
    assert low == pytest.approx(2 * math.atan2(0.6, 0.8))  # it is let go at rest
    assert low < high < math.pi
