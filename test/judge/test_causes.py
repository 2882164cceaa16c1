"""The judge names the causes of errors, or says that it cannot: never what is not so."""

import numpy as np
import pytest
from judge.cases import SECOND
from judge.made import FRD, MOUNT, NED, TILT, Made, heading
from scipy.spatial.transform import Rotation

from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.judgement import judge
from symtop_ros.judge.search import find_causes
from symtop_ros.judge.truth import scene_truth

STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 100)
STEADY = ("hanging", "regular_precession", "sleeping")
N = 5e-3  # rad of noise in each component
# scene, what is wrong, and what is named: the change, the rotations, and the other causes
LOGS = [
    ("cusps", Made(), "", "none", ()),
    ("cusps", Made(change="order"), "order", "none", ()),
    ("looping", Made(change="conjugate", noise=N), "conjugate", "none", ()),
    ("cusps", Made(change="conjugate_order", noise=N), "conjugate_order", "none", ()),
    ("regular_precession", Made(change="conjugate"), "conjugate", "none", ()),
    ("cusps", Made(heading(1.2), change="conjugate"), "conjugate", "heading", ()),
    ("cusps", Made(delay=0.03, change="conjugate"), "conjugate", "none", ("delay",)),
    ("cusps", Made(heading(1.0)), "", "heading", ()),
    ("cusps", Made(TILT, noise=N), "", "world", ()),
    ("looping", Made(body=MOUNT), "", "body", ()),
    ("cusps", Made(TILT, MOUNT), "", "both", ()),
    ("cusps", Made(NED), "ned", "none", ()),
    ("looping", Made(body=FRD, noise=N), "frd", "none", ()),
    ("sleeping", Made(NED, FRD), "ned_frd", "none", ()),
    ("unidirectional", Made(NED, delay=0.02), "ned", "none", ("delay",)),
    ("regular_precession", Made(clock=1e-4), "", "none", ("clock",)),
    ("cusps", Made(delay=0.08), "", "none", ("delay",)),
    ("cusps", Made(heading(0.8), delay=0.05, noise=N), "", "heading", ("delay",)),
    ("cusps", Made(body=MOUNT, delay=0.012), "", "body", ("delay",)),
    ("cusps", Made(drift=0.05), "", "none", ("drift",)),
    ("regular_precession", Made(drift=0.05, noise=N), "", "none", ("drift",)),
    ("cusps", Made(delay=0.02, drift=0.05), None, None, None),  # two parameters
    ("cusps", Made(clock=1e-4), "", "none", ("clock",)),
    ("cusps", Made(spin=0.2, noise=N), "", "none", ("spin",)),
    ("regular_precession", Made(spin=-2.0), "", "none", ("spin",)),
    ("cusps", Made(scale=1e-3), "", "none", ("scale",)),
    ("cusps", Made(other="random"), None, None, None),
    ("cusps", Made(other="walk"), None, None, None),
    ("looping", Made(other="wave", noise=N), None, None, None),
    ("cusps", Made(other="jump"), None, None, None),
    ("regular_precession", Made(other="still", noise=N), None, None, None),
]


def describe(log):
    fields = {k: v for k, v in vars(log[1]).items() if not isinstance(v, Rotation) and v}
    return f"{log[0]}-{log[2]}-{log[3]}-{fields}"


def choose_marks(number, log):
    """Leave logs with noise, which take longest, and every second one to the long trials."""
    return [pytest.mark.long] if log[1].noise or number % 2 else []


@pytest.mark.parametrize(
    "log",
    [pytest.param(log, marks=choose_marks(k, log), id=describe(log)) for k, log in enumerate(LOGS)],
)
def test_the_cause_of_a_made_log_is_named_and_nothing_else(log):
    scene, made, change, level, parameters = log
    truth = scene_truth(scene)
    found = find_causes(made.make(truth, STAMPS), truth)
    if change is None:
        assert not found.explained
        assert found.best.kind == ("", "none", ())
        return
    assert found.explained
    kinds = [each.kind for each in (found.best, *found.others)]
    assert (change, level, parameters) in kinds
    if scene not in STEADY:  # such a top shows a delay as a heading; then both are named
        assert {kind[0] for kind in kinds} == {change}
    cause = (found.best, *found.others)[kinds.index((change, level, parameters))]
    for name in parameters:
        # Noise of 5e-3 rad in 500 estimates: 1e-3 of each value; others are exact to 1e-9.
        assert getattr(cause.offset, name) == pytest.approx(getattr(made, name), rel=5e-3)


@pytest.mark.wording
def test_a_delay_is_known_up_to_periods_of_the_nutation():
    truth = scene_truth("cusps")
    judgement = judge(Made(delay=0.08).make(truth, STAMPS), truth, "x")
    assert judgement.found.period == pytest.approx(0.15954, abs=1e-5)
    text = judgement.format()
    assert "or plus n x 0.1595 s; for n = 1 with a rotation of the world by " in text


@pytest.mark.parametrize("seed", range(3))
def test_a_microsecond_shows_in_noise_of_a_milliradian_with_its_deviation(seed):
    truth, stamps = scene_truth("cusps"), np.arange(SECOND, 11 * SECOND, SECOND // 200)
    found = find_causes(Made(delay=1e-6, noise=1e-3).make(truth, stamps, seed), truth).best
    assert found.kind == ("", "none", ("delay",))
    # 1e-3 rad over some 200 rad/s, in 2000 estimates; the chance of 5 deviations is 6e-7
    assert found.deviations[0] == pytest.approx(1e-3 / 200 / 2000**0.5, rel=0.05)
    assert abs(found.offset.delay - 1e-6) < 5 * found.deviations[0]


def test_a_delay_of_a_motion_with_friction_has_no_period():
    truth = scene_truth("friction")
    found = find_causes(Made(delay=0.08).make(truth, STAMPS), truth)
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
@pytest.mark.parametrize(
    ("model", "error"), [("none", 1.0), ("heading", 0.0), ("world", 0.0), ("world-and-body", 0.0)]
)
def test_a_stated_model_is_aligned_without_a_search(model, error):
    truth = scene_truth("cusps")
    found = judge(Made(heading(1.0)).make(truth, STAMPS), truth, "x", (), model)
    assert found.found is None
    assert found.largest == pytest.approx(error, abs=1e-12)
    assert f"aligned by {model}, without looking for other causes" in found.format()


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
