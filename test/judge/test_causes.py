"""The judge names the causes of errors, or says that it cannot: never what is not so."""

from dataclasses import replace

import numpy as np
import pytest
from judge.cases import SECOND, TILT, Made, heading, make_estimates
from trials import seeds

from symtop_ros.arrays import rotate
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.judgement import judge
from symtop_ros.judge.search import find_causes
from symtop_ros.judge.truth import scene_truth

STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 100)


@pytest.mark.wording
def test_a_delay_is_known_up_to_periods_of_the_nutation():
    truth = scene_truth("cusps")
    judgement = judge(Made(delay=0.08).make(truth, STAMPS[::5]), truth, "x")
    assert judgement.found.period == pytest.approx(0.15954, abs=1e-5)
    text = judgement.format()
    assert "or plus n x 0.1595 s; for n = 1 with a rotation of the world by " in text


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_microsecond_shows_in_noise_of_a_milliradian_with_its_deviation(seed):
    truth, stamps = scene_truth("cusps"), np.arange(SECOND, 11 * SECOND, SECOND // 200)
    found = find_causes(Made(delay=1e-6, noise=1e-3).make(truth, stamps, seed), truth).best
    assert found.kind == ("", "none", ("delay",))
    # 1e-3 rad over some 200 rad/s, in 2000 estimates; the chance of 5 deviations is 6e-7
    assert found.deviations[0] == pytest.approx(1e-3 / 200 / 2000**0.5, rel=0.05)
    assert abs(found.offset.delay - 1e-6) < 5 * found.deviations[0]


def test_a_delay_of_a_motion_with_friction_has_no_period():
    truth, some = scene_truth("friction"), STAMPS[::5]
    found = find_causes(Made(delay=0.08).make(truth, some), truth)
    assert found.best.parameters == ("delay",)
    assert found.period is None


@pytest.mark.wording
@pytest.mark.parametrize("other", ["still", "wave"])
def test_what_is_not_explained_is_said(other):
    truth = scene_truth("cusps")
    text = judge(Made(other=other).make(truth, STAMPS), truth, "x").format()
    wanted = {"still": "not explained: the estimates do not move", "wave": "not explained: every"}
    assert wanted[other] in text
    assert "likely mistake" not in text


@pytest.mark.wording
def test_one_estimate_says_nothing_about_causes():
    truth = scene_truth("cusps")
    judgement = judge(Made(heading(1.0)).make(truth, STAMPS[:1]), truth, "x")
    assert not judgement.found.explained
    assert "not explained: one estimate, 1.00e+00 rad off, says nothing" in judgement.format()
    with pytest.raises(ValueError, match=r"^--remove must have at least 2 estimates .* got 1$"):
        judge(Made().make(truth, STAMPS[:1]), truth, "x", ("offset",))


@pytest.mark.wording
@pytest.mark.parametrize(
    ("model", "error"), [("none", 1.0), ("heading", 0.0), ("world", 0.0), ("world-and-body", 0.0)]
)
def test_a_stated_model_is_aligned_without_a_search(model, error):
    truth = scene_truth("cusps")
    found = judge(Made(heading(1.0)).make(truth, STAMPS), truth, "x", (), model)
    assert found.found is None
    assert found.errors.total.max() == pytest.approx(error, abs=1e-12)
    assert f"aligned by {model}, without looking for other causes" in found.format()


def test_one_estimate_is_aligned_by_two_numbers():
    truth = scene_truth("cusps")
    one = Made(heading(1.0), delay=0.001).make(truth, STAMPS[:1])
    fitted = judge(one, truth, "x", (), "heading+delay").fitted
    assert fitted.offset.delay == pytest.approx(0.001, abs=1e-9)  # stamps are in whole ns
    assert fitted.residual < 1e-14


@pytest.mark.parametrize("model", ["none+delay", "heading+delay+clock"])
def test_a_stated_delay_comes_back_within_its_deviation_in_noise(model):
    truth, pulls = scene_truth("cusps"), []
    for seed in range(20):
        made = Made(delay=2e-6, noise=1e-3).make(truth, STAMPS, seed)
        fitted = judge(made, truth, "x", (), model).fitted
        pulls.append((fitted.offset.delay - 2e-6) / fitted.deviations[0])
    # Of 20 normal numbers the mean square is 0.26 to 2.4 with a probability of 0.999 (chi squared).
    assert 0.26 < np.mean(np.square(pulls)) < 2.4


@pytest.mark.wording
def test_an_estimate_at_the_very_start_does_not_disturb_a_delay():
    truth, stamps = scene_truth("cusps"), STAMPS - SECOND
    exact, *_ = truth.states_at(np.maximum(stamps - 5000, 0))  # late by 5 us, but for the first
    text = judge(Estimates.of(stamps, exact), truth, "x", (), "none+delay").format()
    assert "without looking for other causes: a delay of 0.005 ms" in text


def to_world(estimates):
    return rotate(*estimates.orientations.T, estimates.angular_velocities)


TWO = "in deg/s, in the world frame"
RATES = {
    "in deg/s": lambda e: np.degrees(e.angular_velocities),
    "in the world frame": to_world,
    TWO: lambda e: np.degrees(to_world(e)),
}


@pytest.mark.parametrize(("mistake", "angle"), [*((each, 0.0) for each in RATES), (TWO, 1.0)])
def test_a_mistake_of_the_rates_is_named(mistake, angle):
    truth = scene_truth("cusps")
    good = make_estimates(truth, STAMPS[::5], heading(angle))
    bad = replace(good, angular_velocities=RATES[mistake](good))
    (note,) = judge(bad, truth, "x").notes
    assert note.startswith("likely mistake: the angular ")
    assert note.endswith(mistake)


def test_good_estimates_and_plain_errors_are_no_mistakes():
    truth = scene_truth("cusps")
    for turned in ((), (TILT,)):
        good = make_estimates(truth, STAMPS[::5], *turned)
        assert judge(good, truth, "x").notes == ()
