"""Causes that explain a part of the errors: their share, and what is left."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth.judge.cases import NED, SECOND, Made, heading, write_rows, wxyz
from truth.judge.test_noise import EVEN, make_noisy

from symtop_ros.base.arrays import compose
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.residuals.bootstrap import DRAWS, draw_gains
from symtop_ros.truth.topics.estimates import Estimates

TRUTH = scene_truth("cusps")
STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 200)
NUMBER = r"(\d[\d.]*)"
SWING = 2e-3  # rad, root mean square


def swing(estimates, frequency, axis=2):
    """swing estimates about an axis of the body."""
    vectors = np.zeros((len(estimates), 3))
    seconds = estimates.stamps / SECOND
    vectors[:, axis] = SWING * 2**0.5 * np.sin(2 * np.pi * frequency * seconds + 0.7)
    turned = compose(estimates.orientations, wxyz(Rotation.from_rotvec(vectors)))
    return replace(estimates, orientations=turned)


@pytest.mark.slow
@pytest.mark.parametrize("frequency", [0.3, 3.0, 20.0])
def test_a_heading_under_a_swing_is_said_with_its_share_and_the_swing_as_a_line(frequency):
    made = Made(world=heading(0.5), noise=1e-3).make(TRUTH, STAMPS)
    judgement = judge(swing(made, frequency), TRUTH, "x")
    text, facts = judgement.format(), judgement.facts()["found"]
    share = re.search(rf"^a heading of 0.500 rad leaves {NUMBER} of {NUMBER} mrad rms$", text, re.M)
    assert share, text
    # 1 mrad along each axis, and the swing
    assert float(share[1]) == pytest.approx(1e3 * np.hypot(SWING, 3**0.5 * 1e-3), rel=0.1)
    assert float(share[2]) == pytest.approx(500, abs=3)
    line = re.search(rf"line is {NUMBER} mrad at {NUMBER} Hz about the body's axis$", text, re.M)
    assert line, text
    assert float(line[1]) == pytest.approx(1e3 * SWING, rel=0.15)
    assert float(line[2]) == pytest.approx(frequency, abs=0.1)  # half of 1/T
    assert not facts["explained"]
    assert facts["share"] == pytest.approx(1 - float(share[1]) / float(share[2]), abs=1e-3)
    assert facts["candidate"]["world_offset"]["deviation"] is None  # it has no honest one


@pytest.mark.slow
@pytest.mark.parametrize("name", ["nutation", "spin"])
def test_a_line_at_a_frequency_of_the_motion_has_its_name(name):
    made = Made(world=heading(0.5), noise=1e-3).make(TRUTH, STAMPS)
    judgement = judge(swing(made, TRUTH.frequencies[name]), TRUTH, "x")
    assert f" about the body's axis (the {name})" in judgement.format()
    assert judgement.facts()["found"]["line"]["name"] == name


MISTAKES = {  # what a note says, and the name in JSON
    "x, y, z, w": (lambda q: q[:, [1, 2, 3, 0]], "order"),
    "conjugate": (lambda q: q * [1, -1, -1, -1], "conjugate"),
    "north-east-down": (lambda q: compose(wxyz(NED), q), "ned"),
    "x has the other sign": (lambda q: q * [1, -1, 1, 1], "w,-x,y,z"),
    "hold y, w, z, x": (lambda q: q[:, [2, 0, 3, 1]] * [1, 1, -1, 1], "y,w,-z,x"),
}


@pytest.mark.slow
@pytest.mark.parametrize("words", MISTAKES)
def test_a_mistake_in_the_noise_of_a_filter_is_below_the_sentence_that_says_so(words):
    make, name = MISTAKES[words]
    noisy = make_noisy(200, 5, 0.05, EVEN, False, 3)
    judgement = judge(Estimates.of(noisy.stamps, make(noisy.orientations)), TRUTH, "x")
    text, facts = judgement.format(), judgement.facts()
    sentence, note = text.index("the mistake below leaves "), text.index("likely mistake: ")
    assert sentence < note
    assert words in text[note:]
    assert facts["found"]["mistake"] == facts["found"]["candidate"]["mistake"] == name
    assert any(words in each for each in facts["notes"])


@pytest.mark.slow
def test_of_errors_without_a_cause_it_is_said_how_little_any_explains():
    made = Made(noise=1e-3).make(TRUTH, STAMPS)
    judgement = judge(swing(made, 3.0), TRUTH, "x")
    text, facts = judgement.format(), judgement.facts()["found"]
    found = re.search(rf"no cause explains more than {NUMBER} % of ", text)
    assert found, text
    assert facts["share"] <= float(found[1]) / 100 < facts["share"] + 0.01
    assert facts["candidate"] is None
    pattern = rf"its strongest spectral line is {NUMBER} mrad at 3.00 Hz about the body's axis"
    line = re.search(pattern, text)
    assert line, text
    assert float(line[1]) == pytest.approx(1e3 * SWING, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [137, 400])
def test_stamps_that_are_cut_to_milliseconds_are_the_cause(rate):
    stamps = SECOND + 123_457 + np.rint(np.arange(5 * rate) * SECOND / rate).astype(np.int64)
    made = Made(noise=1e-4).make(TRUTH, stamps)
    cut = replace(made, stamps=stamps // 10**6 * 10**6)
    late = (cut.stamps - stamps) / SECOND
    judgement = judge(cut, TRUTH, "x")
    facts = judgement.facts()["found"]
    assert "and stamps that are rounded or cut to 1 ms, which have a jitter of 0.2" in (
        judgement.format()
    )
    assert facts["explained"]
    # noise of 0.1 mrad in a thousand rows, at some 140 rad/s
    assert facts["delay"] == pytest.approx(late.mean(), abs=5e-7)
    assert facts["stamp_steps"]["jitter"] == pytest.approx(late.std(), rel=0.01)
    # noise has two components across the angular velocity
    assert facts["stamp_steps"]["left"] == pytest.approx(1e-4 * 2**0.5, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("digits", [6, 9])
def test_rows_of_two_bags_count_once_also_with_fewer_decimals_or_the_other_sign(
    digits, tmp_path, capsys
):
    made = Made(delay=5e-6, noise=1e-3).make(TRUTH, STAMPS)
    texts = []
    for q in (made.orientations, -np.round(made.orientations, digits)):
        rows = write_rows(replace(made, orientations=q), header=("t", "w", "x", "y", "z"))
        texts += [",".join(line.split(",")[:5]) for line in rows.splitlines()]
    head, *rows = texts
    path = tmp_path / "merged.csv"
    found = []
    for lines in ([head, *rows[: len(made)]], [head, *(row for row in rows if row != head)]):
        path.write_text("\n".join([*lines, ""]))
        assert main(["--scene", "cusps", "--estimates", str(path)]) == 0
        found.append(capsys.readouterr().out.splitlines())
    once, twice = found
    assert twice[: len(once)] == once
    assert twice[len(once) :] == [
        "note: 1000 rows are there a second time, the first at 1 s: counted once"
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("noise", "count"), [(1e-3, 25), (5e-3, 12)])
def test_frames_with_a_delay_and_outliers_are_no_rotation(noise, count):
    """In a fast top with little nutation delays are as good up to a turn of the spin, nearly."""
    truth, random = scene_truth("disc"), np.random.default_rng(5)
    stamps = np.sort(random.integers(SECOND, 6 * SECOND, 500))
    made = Made(world=NED, delay=0.027, noise=noise).make(truth, stamps)
    q = made.orientations.copy()
    q[random.choice(np.arange(1, 500), count, replace=False)] = wxyz(
        Rotation.random(count, random_state=5)
    )
    judgement = judge(Estimates.of(stamps, np.round(q, 6)), truth, "x", robust=True)
    assert judgement.found.best.kind == ("ned", "none", ("delay",))
    assert "north-east-down" in judgement.format()


def test_gains_by_chance_are_those_of_as_many_numbers_as_are_fitted():
    """Of white noise a fit explains p of 3 n independent squares."""
    random = np.random.default_rng(1)
    columns, left = random.normal(size=(500, 3, 4)), random.normal(size=(500, 3))
    gains = draw_gains(columns, left, 500.0)
    # The sum of 4 squares of normal numbers has a mean of 4 and a deviation of sqrt(8).
    spread = (8 / DRAWS) ** 0.5 / 1500
    assert abs(gains.mean() - 4 / 1496) < 4 * spread


def test_gains_in_errors_that_last_are_larger():
    columns = np.ones((500, 1, 1))
    steps = np.random.default_rng(2).normal(size=(20, 1)).repeat(25, axis=0)
    # blocks of 50 rows in place of 2, of which each reaches over two or three steps
    assert draw_gains(columns, steps, 20.0).mean() > 5 * draw_gains(columns, steps, 500.0).mean()
