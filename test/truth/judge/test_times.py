"""Times of tables in other units and epochs, and quaternions of other norms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth.judge.cases import SECOND, Made, heading, write_rows

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.judge.attitude_table import read_attitudes
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.judge.times import read_times
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.topics.estimates import Estimates

TRUTH = scene_truth("cusps")
STAMPS = range(0, 2 * SECOND, SECOND // 100)
NAMES = ("t", "w", "x", "y", "z")


def make(stamps=STAMPS, made=None):
    return (made or Made(heading(0.3))).make(TRUTH, np.array(stamps))


def read(path, estimates, *, factor=1, shift=0):
    """Write estimates with times t in a unit so many times smaller, and read them again."""
    if estimates.angular_velocities is None:
        estimates = replace(estimates, angular_velocities=np.zeros((len(estimates), 3)))
    rows = write_rows(estimates, header=NAMES, order=range(4)).splitlines()
    changed = [rows[0]]
    for stamp, row in zip(estimates.stamps.tolist(), rows[1:], strict=True):
        time = (stamp + shift) * factor
        changed.append(f"{time // SECOND}.{time % SECOND:09d},{row.partition(',')[2]}")
    path.write_text("\n".join(changed))
    return read_times(read_attitudes(path), TRUTH, "file", False)


EPOCH = 1_403_636_579_758_555_392  # of a published record, in ns
CHANGES = [
    *((factor, 0) for factor in (1, 10**3, 10**6, 10**9)),
    *((factor, EPOCH) for factor in (1, 10**3, 10**6, 10**9)),
    (1, 100 * SECOND * 86_400),
]


@pytest.mark.parametrize(("factor", "shift"), CHANGES)
def test_a_unit_and_an_epoch_are_found_and_said(factor, shift, tmp_path):
    estimates = make()
    found = read(tmp_path / "a.csv", estimates, factor=factor, shift=shift)
    assert found.stamps.tolist() == estimates.stamps.tolist()
    notes = [note for note in found.notes if note.startswith("likely mistake: ")]
    assert len(notes) == (factor != 1 or shift != 0)
    for note in notes:
        assert (f"{1 / factor:.0e}".replace("e-0", "e-") in note) == (factor != 1)
        assert ("another epoch" in note) == (shift != 0)


@pytest.mark.parametrize("seed", range(4))
def test_other_times_of_attitudes_that_are_no_motion_are_refused(seed, tmp_path):
    stamps = make().stamps
    q = Rotation.random(len(stamps), random_state=seed).as_quat()
    with pytest.raises(RefusedError, match="the first estimate is 44 years after the start of"):
        read(tmp_path / "a.csv", Estimates.of(stamps, q), shift=EPOCH)


OTHERS = [Made(delay=0.1), Made(noise=0.01), Made(other="wave"), Made(change="order")]


@pytest.mark.parametrize("made", [*OTHERS, Made(other="still"), Made(heading(1.0), drift=0.2)])
def test_a_late_start_and_other_causes_are_no_other_unit(made, tmp_path):
    estimates = make(range(SECOND, 4 * SECOND, SECOND // 100), made)
    found = read(tmp_path / "a.csv", estimates)
    assert found.stamps.tolist() == estimates.stamps.tolist()
    assert found.notes == ()


def test_a_run_of_forty_years_has_tenths():
    """Ten times its nanoseconds are beyond 64 bits."""
    stamps = [0, EPOCH // 2, EPOCH]
    exact = Estimates.of(stamps, [[1.0, 0.0, 0.0, 0.0]] * 3)
    assert judge(exact, scene_truth("hanging"), "x").errors.growth().shape == (10,)


NOTE = " did not have the norm 1, and were divided by the norm (norm 57.3)"
NORMS = [(1.0, ""), (1.0005, ""), (57.3, NOTE)]


@pytest.mark.parametrize(("norm", "note"), NORMS)
def test_norms_that_are_no_rounding_are_said(norm, note, tmp_path, capsys):
    estimates = make(made=Made())
    rows = write_rows(estimates, header=NAMES).splitlines()
    cells = [row.split(",") for row in rows[1:]]
    scaled = [",".join([t, *(repr(norm * float(c)) for c in q[:4])]) for t, *q in cells]
    path = tmp_path / "scaled.csv"
    path.write_text("\n".join([rows[0], *scaled]))
    assert main(["--scene", "cusps", "--estimates", str(path)]) == 0
    assert ("the norm 1" in capsys.readouterr().out) == bool(note)
    notes = [
        each.removeprefix("200 of 200 quaternions") for each in read_attitudes(path).read().notes
    ]
    assert notes == [note] * bool(note)
