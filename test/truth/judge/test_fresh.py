"""The trial of workshop/judge: files that share no formula with the judge, and what it says.

docs/trials.md has the counts.
"""

import importlib

import numpy as np
import pytest

from workshop.judge.causes import Fault, scale_rates
from workshop.judge.motion import BEGIN, draw_path, find_angles
from workshop.judge.reading import read_verdict
from workshop.judge.trial import ALL_NOISES, FILES, WITHOUT, Random, draw_file, find_rms, try_file

# One of each noise but filters, whose packages are those of the trial.
OFTEN = (1, 6, 8, 9, 16)
PEERS = "ahrs", "vqf", "imufusion"
FALSE = 0.02  # part of the files without a cause that may get a name; docs/trials.md promises it
LEAST = 0.9  # part of all that is right, or said with its share


@pytest.mark.slow
@pytest.mark.parametrize("number", OFTEN)
def test_what_is_said_of_a_file_is_true(number):
    row = try_file(number)
    assert row.outcome in ("right", "share"), row.text


@pytest.mark.long
def test_what_is_said_of_all_files_is_true():
    for name in PEERS:
        importlib.import_module(name)
    rows = [try_file(number) for number in range(FILES)]
    for noise in ALL_NOISES:
        own = [row for row in rows if row.noise == noise and row.cause in WITHOUT]
        wrong = [row.name for row in own if row.outcome == "wrong"]
        assert len(wrong) <= FALSE * len(own), wrong
    good = sum(row.outcome in ("right", "share") for row in rows)
    assert good >= LEAST * FILES, [
        row.name for row in rows if row.outcome not in ("right", "share")
    ]
    rms, count = find_rms(rows)
    assert sum(row.outcome == "wrong" for row in rows) <= FALSE * FILES
    assert count >= 40  # docs/trials.md has 51
    assert 0.8 <= rms <= 1.25


def test_files_are_the_same_again():
    one, other = draw_file(7), draw_file(7)
    assert one.name == other.name
    assert (one.rows == other.rows).all()


def test_a_motion_in_steady_precession_keeps_its_tilt():
    course = draw_path(Random("tilt"), "steady")
    q = course.attitudes(np.linspace(0.0, 5.0, 50))
    tilt = np.arccos(1 - 2 * (q[:, 1] ** 2 + q[:, 2] ** 2))
    # the integration is exact to 1e-12 a step, of which there are some thousands
    assert np.ptp(tilt) < 1e-7


def test_a_scale_of_nothing_changes_nothing():
    course = draw_path(Random("scale"), "nutating")
    times = BEGIN + np.linspace(0.0, 2.0, 20)
    off = find_angles(scale_rates(course, times, 0.0), course.attitudes(times))
    assert off.max() < 1e-7


@pytest.mark.wording
def test_sentences_are_read_with_all_their_numbers():
    named = (
        "best explained by a delay of 3.00 +- 0.02 ms + n x 31.4 ms, a heading of -0.30 +- 0.01 "
        "rad + n x 0.2 rad; this leaves 1.7e-03 rad rms\n"
        "or equally well by a drift of the heading of 0.1 rad/s from 0.600 s on"
    )
    first, other = read_verdict(named).causes
    assert first.values == {"delay": pytest.approx(3e-3), "heading": -0.3}
    assert first.deviations == {"delay": pytest.approx(2e-5), "heading": 0.01}
    assert first.steps == {"delay": pytest.approx(0.0314), "heading": 0.2}
    assert other.names == {"drift"}
    share = read_verdict(
        "the mistake below, a rotation of the body by 1.57 rad (90 degrees about z) leave 7 of 900 "
        "mrad rms\nnote: likely mistake: the quaternions have the order x, y, z, w"
    )
    assert (share.left, share.whole, share.is_named) == (pytest.approx(7e-3), 0.9, False)
    assert share.causes[0].names == {"xyzw", "body"}
    assert share.causes[0].as_fault().body == (0.0, 0.0, 1.57)
    assert read_verdict("not explained: the estimates do not move").causes == []


def test_a_fault_is_undone_by_its_own_opposite():
    course = draw_path(Random("fault"), "nutating")
    times = BEGIN + np.linspace(0.0, 2.0, 20)
    late = Fault("delay", {"delay": 0.01}).model(course, times)
    assert find_angles(late, course.attitudes(times - 0.01)).max() < 1e-9
