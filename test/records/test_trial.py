"""Records that do not share the assumptions of `top_fit`: what it says of some, and of many."""

import numpy as np
import pytest

from workshop.records.draws import CLEAN, FAULTS
from workshop.records.trial import run_trial, try_record, write_table

FAR = 5.0  # deviations; a normal number is farther once in two million


def list_far(pulls):
    return {name: pull for name, pull in pulls.items() if not abs(pull) < FAR}


@pytest.mark.slow
@pytest.mark.parametrize("name", CLEAN)
def test_of_a_record_without_a_fault_the_model_holds_and_numbers_are_right(name):
    row = try_record(name, 3)
    assert (row["status"], row["verdict"]) == (0, "holds")
    assert len(row["pulls"]) >= 5
    assert list_far(row["pulls"]) == {}


@pytest.mark.slow
def test_a_motion_that_all_searches_miss_is_not_explained_by_a_kick():
    """The motion of the first rows leads to it; with a kick of zero it would be the best one."""
    row = try_record("film, aim known", 11)
    assert (row["status"], row["verdict"]) == (0, "holds")
    assert list_far(row["pulls"]) == {}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2, 11])  # a range of sensors or none, with and without Iz/Ix
def test_a_spin_beyond_the_range_is_left_out_and_the_others_show_what_they_do(seed):
    row = try_record("spin beyond the range", seed)
    assert row["verdict"] == "holds"
    assert "the spin is beyond it" in row["notes"][0]
    assert {"nutation_period"} < set(row["pulls"])
    assert list_far(row["pulls"]) == {}


# The numbers are off by many deviations of the noise, which no look at what is left tells.
QUIET = "aim", "stretch", "shutter", "time base"


@pytest.mark.slow
@pytest.mark.parametrize("name", QUIET)
def test_of_a_fault_that_leaves_nothing_the_deviations_in_all_allow_for_it(name):
    row = try_record(name, 0)
    assert row["verdict"] == "holds"
    assert list_far(row["pulls"]) != {}
    assert list_far(row["totals"]) == {}


@pytest.mark.slow
def test_a_mirrored_film_is_said_to_be_possible():
    row = try_record("mirrored", 0)
    assert any("mirrored picture" in each for each in row["unknown"])
    assert abs(row["pulls"]["Mgl/Ix"]) < FAR
    assert abs(row["pulls"]["p_psi/Ix"]) > FAR


@pytest.mark.slow
@pytest.mark.parametrize("name", ["asymmetric, rates", "dry friction, rates"])
def test_of_another_body_the_model_does_not_hold(name):
    assert try_record(name, 0)["verdict"] != "holds"


@pytest.mark.long
def test_records_of_all_faults():
    """Of 300 clean records at most 2 % are doubted, and deviations in all are honest."""
    rows = run_trial([*CLEAN], range(60))
    print("\n".join(write_table(rows)))
    doubted = [row for row in rows if row["verdict"] != "holds"]
    assert len(doubted) <= 0.02 * len(rows)
    pulls = [pull for row in rows for pull in row["pulls"].values()]
    # 1800 pulls, some of which hang together as those of 300 do: their root mean square is 1 but
    # for 0.04, once in 300 three times as much
    assert 0.88 < np.sqrt(np.mean(np.square(pulls))) < 1.12
    rows = run_trial([*FAULTS], range(40))
    print("\n".join(write_table(rows)))
    for name in QUIET:
        totals = [p for row in rows if row["name"] == name for p in row["totals"].values()]
        assert np.mean(np.abs(totals) < 2) > 0.9
