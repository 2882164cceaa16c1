"""Two hosts whose link loses frames, in a small form: what the user counts, and the rows."""

import pytest

from workshop.load import links
from workshop.load.follower import count_lost
from workshop.load.two_hosts import Weather, why_not

skip = pytest.mark.skipif(bool(why_not()), reason=f"no two hosts here: {why_not()}")


def test_stamps_that_are_missing_are_counted_in_whatever_order_the_others_arrive():
    stamps = (10, 30, 20, 60, 60)
    assert count_lost([stamp * 1_000_001 + 7 for stamp in stamps], 10_000_000) == 2


def test_a_row_has_the_lost_of_all_and_milliseconds():
    seen = {"lost": 1, "count": 3, "delays": [0.001, 0.002, 0.003], "kicks": [0.004, 0.01]}
    assert links.format_cells(seen) == ["1 of 4", "2, 3", "7, 10"]


@skip
@pytest.mark.long
@pytest.mark.untraced
def test_each_link_has_a_row(capsys, monkeypatch):
    bad = {"clear": Weather(), "5 % lost": Weather(loss=0.05, delay=0.02)}
    monkeypatch.setattr(links, "LINKS", bad)
    assert links.main(["--seconds", "1"]) == 0
    rows = [line.split(" | ") for line in capsys.readouterr().out.splitlines()]
    assert [row[:2] for row in rows] == [
        ["clear", "none"],
        ["5 % lost", "none"],
        ["5 % lost", "lossy"],
    ]
    assert all(len(row) == len(links.HEAD) for row in rows)
