"""Starts by an address: over 300 decades, and by the links that the page writes."""

import random

import pytest
from web.odd_tops import draw_start, write_address
from web.opened import UNDRAWN

LONGEST = 1000  # ms
# An axis of values far larger than their span: k + 1 is k.
HANGING = "#Ix=1&Iz=0.5&Mgl=0&theta=0.5&psi_dot=25&precession=fast"
# The time until what an address starts is shown.
OPEN = """(hash) => new Promise((done) => {
    const begin = performance.now();
    const end = () => done(performance.now() - begin);
    addEventListener("hashchange", () => requestAnimationFrame(() => requestAnimationFrame(end)),
        {once: true});
    location.hash = hash;
})"""


@pytest.mark.parametrize("count", [50, pytest.param(500, marks=pytest.mark.long)])
def test_starts_over_300_decades_open_in_a_second_each(open_page, count):
    opened, rng = open_page(script=UNDRAWN), random.Random(49)
    for address in (HANGING, *(write_address(draw_start(rng)) for _ in range(count))):
        assert opened.tab.evaluate(OPEN, address) < LONGEST, address
        assert opened.problems == [], address
    opened.press("r")
    assert opened.say("refusal") == ""
