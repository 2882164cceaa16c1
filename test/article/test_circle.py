"""Nutation as a point on a circle that moves along: how nearly, and the numbers of the article."""

import math

import numpy as np
from documents import ROOT

from symtop_ros.physics import Motion
from workshop.article.answers.circle import find_nutation
from workshop.article.motions import TOP, start

ARTICLE = " ".join((ROOT / "docs/article.md").read_text().split())


def find(spin):
    motion = Motion(TOP, start(0.0, spin))
    found = find_nutation(motion, np.linspace(0.0, motion.nutation_period, 801))
    off = np.abs(np.hypot(found.across, found.down) / found.radius - 1).max()
    return found, float(off)


def test_the_numbers_of_the_article_are_those_of_the_motion():
    found, off = find(200.0)
    fast, _ = find(2000.0)
    cusps = Motion(TOP, start(0.0, 200.0))
    mean, round_it = float(cusps.mean_precession_rate), found.radius * found.rate
    at_cusps = mean * math.sin(cusps.turning_angles[0])
    for text in (
        f"precession of {mean:.2f} rad/s",
        f"moves along at {at_cusps:.2f} rad/s",
        f"differ by {100 * (1 - at_cusps / round_it):.1f} %",
        f"radius {found.radius:.3f} rad",
        f"within {100 * off:.1f} %",
        f"{found.rate:.1f} rad/s",
        f"L/Ix = {found.free_rate:.1f} rad/s",
        f"{fast.rate:.1f} and {fast.free_rate:.1f} rad/s",
        f"{found.drift:.2f} rad/s",
        f"{round_it:.2f} rad/s",
    ):
        assert text in ARTICLE, text
