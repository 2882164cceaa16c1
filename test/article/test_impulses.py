"""The impulses of one fall: they make theta', and the numbers of the documents are theirs."""

import re

import pytest
from documents import ROOT

from workshop.article.answers.impulses import find_impulses
from workshop.article.motions import TOP, cusps
from workshop.article.nutation import times_of_extreme_rate

MOTION = cusps()
FASTEST = times_of_extreme_rate(MOTION)[0]
BOTTOM = MOTION.nutation_period / 2
ARTICLE = ROOT / "docs/article.md"
ROUNDING = 1e-15  # N m s; 64 products of up to 3e-3 N m s are summed


@pytest.mark.parametrize("time", [0.01, 0.025, FASTEST, 0.0625, BOTTOM])
def test_the_sum_of_the_impulses_is_the_momentum_of_the_fall(time):
    rate = float(MOTION.at(time).euler_rates.theta_dot)
    assert find_impulses(MOTION, time).total == pytest.approx(TOP.Ix * rate, abs=ROUNDING)


def write(time):
    found = find_impulses(MOTION, time)
    parts = (found.gravity, found.coriolis, found.centrifugal, found.total)
    return [f"{1e3 * time:.1f}", *(f"{1e3 * each:+.3f}" for each in parts)]


def test_the_table_of_the_article_has_the_impulses():
    rows = re.findall(r"^\| (\d+\.\d) \| (.*) \|$", ARTICLE.read_text(), re.MULTILINE)
    table = [[time, *numbers.split(" | ")] for time, numbers in rows]
    expected = [write(FASTEST), write(BOTTOM)]
    assert expected[1][-1] in ("+0.000", "-0.000")
    expected[1][-1] = "0"
    assert table == expected
