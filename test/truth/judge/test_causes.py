"""The judge names the causes of errors and the clock of stamps, or says that it cannot."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from trials import choose, seeds
from truth.judge.cases import SECOND, TILT, Made, heading, make_estimates, turn_z, write_rows

from symtop_ros.base.arrays import compose, rotate
from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.log.intervals import Interval
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.events import start_event
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.judge.clock import measure_clock
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.judge.search import find_causes
from symtop_ros.truth.judge.truth import Truth, scene_truth
from symtop_ros.truth.topics.estimates import Estimates

TRUTH = scene_truth("cusps")
STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 100)


@pytest.mark.slow
@pytest.mark.wording
def test_a_delay_is_known_up_to_periods_of_the_nutation():
    judgement = judge(Made(delay=0.08).make(TRUTH, STAMPS[::5]), TRUTH, "x")
    assert judgement.found.period == pytest.approx(0.15954, abs=1e-5)
    text = judgement.format()
    assert "or plus n x 0.1595 s; for n = 1 with a rotation of the world by " in text


@pytest.mark.slow
@pytest.mark.parametrize("seed", choose(range(40), (20,)))
def test_noise_of_a_short_run_is_no_delay_that_leaves_the_loudest_estimates_out(seed):
    end = 22 * SECOND // 10
    whole, truth = scene_truth("disc"), scene_truth("disc")
    truth.end = end
    estimates = Made(noise=1e-3).make(whole, np.arange(0, end + 1, SECOND // 100), seed)
    found = find_causes(estimates, truth)
    assert (found.explained, found.best.kind) == (True, ("", "none", ()))


@pytest.mark.slow
def test_in_a_sleeping_top_a_delay_is_called_a_heading_whatever_is_lost_of_the_log():
    truth = scene_truth("sleeping")
    event = start_event(start_motion(Settings.from_scene("sleeping")))
    lost = Interval(3 * SECOND, 4 * SECOND, None, "lost")
    parts = Interval(0, 3 * SECOND, event), lost, Interval(4 * SECOND, 9 * SECOND, event)
    damaged = Truth.of(SimpleNamespace(end=8 * SECOND, intervals=parts))
    assert damaged.kind == truth.kind == "sleeping"
    for each in (truth, damaged):
        found = find_causes(Made(delay=0.00636, noise=1e-3).make(truth, STAMPS[::4]), each)
        assert found.best.kind == ("", "heading", ())
        assert "delay" in found.hidden


@pytest.mark.slow
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_microsecond_shows_in_noise_of_a_milliradian_with_its_deviation(seed):
    stamps = np.arange(SECOND, 11 * SECOND, SECOND // 200)
    found = find_causes(Made(delay=1e-6, noise=1e-3).make(TRUTH, stamps, seed), TRUTH).best
    assert found.kind == ("", "none", ("delay",))
    # 1e-3 rad over some 200 rad/s, in 2000 estimates; the chance of 5 deviations is 6e-7
    assert found.deviations[0] == pytest.approx(1e-3 / 200 / 2000**0.5, rel=0.05)
    assert abs(found.offset.delay - 1e-6) < 5 * found.deviations[0]


def test_a_delay_of_a_motion_with_friction_has_no_period():
    truth = scene_truth("friction")
    some = STAMPS[::20]
    found = find_causes(Made(delay=0.08).make(truth, some), truth)
    assert found.best.parameters == ("delay",)
    assert found.period is None


@pytest.mark.wording
@pytest.mark.parametrize("other", ["still", "wave"])
def test_what_is_not_explained_is_said(other):
    text = judge(Made(other=other).make(TRUTH, STAMPS), TRUTH, "x").format()
    wanted = {
        "still": "not explained: the estimates do not move",
        "wave": " rad rms is correlated over ",
    }
    assert wanted[other] in text
    assert "likely mistake" not in text


@pytest.mark.wording
def test_one_estimate_says_nothing_about_causes():
    judgement = judge(Made(heading(1.0)).make(TRUTH, STAMPS[:1]), TRUTH, "x")
    assert not judgement.found.explained
    assert "not explained: one estimate, 1.00e+00 rad off, says nothing" in judgement.format()
    with pytest.raises(ValueError, match=r"^--remove must have at least 2 estimates .* got 1$"):
        judge(Made().make(TRUTH, STAMPS[:1]), TRUTH, "x", ("offset",))


MODELS = [("none", 1.0), ("heading", 0.0), ("world", 0.0), ("world-and-body", 0.0)]


@pytest.mark.wording
@pytest.mark.parametrize(("model", "error"), MODELS)
def test_a_stated_model_is_aligned_without_a_search(model, error):
    found = judge(Made(heading(1.0)).make(TRUTH, STAMPS), TRUTH, "x", (), model)
    assert found.found is None
    assert found.errors.total.max() == pytest.approx(error, abs=1e-12)
    assert f"aligned by {model}, without looking for other causes" in found.format()


def test_one_estimate_is_aligned_by_two_numbers():
    one = Made(heading(1.0), delay=0.001).make(TRUTH, STAMPS[:1])
    fitted = judge(one, TRUTH, "x", (), "heading+delay").fitted
    assert fitted.offset.delay == pytest.approx(0.001, abs=1e-9)  # stamps are in whole ns
    assert fitted.residual < 1e-14


@pytest.mark.parametrize("model", ["none+delay", "heading+delay+clock"])
def test_a_stated_delay_comes_back_within_its_deviation_in_noise(model):
    pulls = []
    for seed in range(20):
        made = Made(delay=2e-6, noise=1e-3).make(TRUTH, STAMPS, seed)
        fitted = judge(made, TRUTH, "x", (), model).fitted
        pulls.append((fitted.offset.delay - 2e-6) / fitted.deviations[0])
    # Of 20 normal numbers the mean square is 0.26 to 2.4 with a probability of 0.999 (chi squared).
    assert 0.26 < np.mean(np.square(pulls)) < 2.4


@pytest.mark.wording
def test_an_estimate_at_the_very_start_does_not_disturb_a_delay():
    stamps = STAMPS - SECOND
    exact, *_ = TRUTH.states_at(np.maximum(stamps - 5000, 0))  # late by 5 us, but for the first
    text = judge(Estimates.of(stamps, exact), TRUTH, "x", (), "none+delay").format()
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
    good = make_estimates(TRUTH, STAMPS[::5], heading(angle))
    bad = replace(good, angular_velocities=RATES[mistake](good))
    (note,) = judge(bad, TRUTH, "x").notes
    assert note.startswith("likely mistake: the angular ")
    assert note.endswith(mistake)


@pytest.mark.parametrize("growth", [3.0, 60.0, 1e4])
def test_rates_of_an_engine_that_diverges_are_no_mistake_of_units(growth):
    good = make_estimates(TRUTH, STAMPS[::5])
    grown = growth ** np.linspace(0, 1, len(good))[:, np.newaxis]
    for signs in ((1, -1, 1), (1, 1, 1), (-1, 1, -1)):
        rates = good.angular_velocities * grown * signs
        assert judge(replace(good, angular_velocities=rates), TRUTH, "x").notes == ()


@pytest.mark.parametrize(("turned", "model"), [((), None), ((TILT,), "world")])
def test_good_estimates_and_plain_errors_are_no_mistakes(turned, model):
    good = make_estimates(TRUTH, STAMPS[::5], *turned)
    assert judge(good, TRUTH, "x", aligned=model).notes == ()


OFTEN = np.arange(SECOND, 6 * SECOND, SECOND // 400)
NOISE = 1e-3  # rad
FASTEST = 140.0  # rad/s, about: the angular velocity of this scene


@pytest.mark.parametrize("made", [Made(noise=NOISE), Made(TILT, noise=NOISE)])
@pytest.mark.parametrize(("delay", "rate"), [(1e-6, 0.0), (0.0, 1e-6), (-40e-6, 25e-6)])
def test_a_delay_and_a_rate_are_found_within_five_deviations(made, delay, rate):
    made = Made(made.world, delay=delay, clock=rate, noise=NOISE)
    clock = measure_clock(made.make(TRUTH, OFTEN), TRUTH, "file", "world")
    # An offset of `Made` grows from the first stamp on; the delay is that in the middle.
    middle = delay + rate * (OFTEN[-1] - OFTEN[0]) / 2e9
    assert abs(clock.delay - 1e6 * middle) < 5 * clock.delay_deviation
    assert abs(clock.rate - 1e6 * rate) < 5 * clock.rate_deviation
    # n stamps over T seconds give a delay to d / sqrt(n) and a rate to sqrt(12) d / (T sqrt(n)),
    # where d is the noise over the angular velocity; twice that for what the rotations take.
    seconds = 1e6 * NOISE / FASTEST / np.sqrt(len(OFTEN))
    assert clock.delay_deviation < 2 * seconds
    assert clock.rate_deviation < 2 * np.sqrt(12) / 5 * seconds


def test_jitter_is_told_from_noise_and_from_a_late_clock_and_noise_is_not_jitter():
    made = Made(delay=-40e-6, clock=1e-5, noise=NOISE)
    # the true times differ from the stamps by noise
    times = OFTEN + np.rint(np.random.default_rng(5).normal(0, 10e-6 * SECOND, len(OFTEN)))
    estimates = replace(made.make(TRUTH, times.astype(np.int64)), stamps=OFTEN)
    clock = measure_clock(estimates, TRUTH, "file")
    # this top turns about its axis but for 2 degrees: noise of 1 mrad hides the difference
    assert clock.kind == "either"
    # A variance from n estimates has a deviation of sqrt(2 / n), at most sqrt(3) times that here.
    assert abs(clock.jitter - 10) < 10 * 5 * np.sqrt(1.5 / len(OFTEN))

    clock = measure_clock(Made(noise=NOISE).make(TRUTH, OFTEN), TRUTH, "file")
    assert clock.kind == "none"
    assert clock.jitter < 1e6 * NOISE / FASTEST


def test_large_jitter_is_told_from_noise_about_an_axis():
    made = Made(noise=NOISE / 100)
    times = OFTEN + np.rint(np.random.default_rng(5).normal(0, 100e-6 * SECOND, len(OFTEN)))
    estimates = replace(made.make(TRUTH, times.astype(np.int64)), stamps=OFTEN)
    clock = measure_clock(estimates, TRUTH, "file")
    assert clock.kind == "jitter"
    assert abs(clock.jitter - 100) < 100 * 5 * np.sqrt(1.5 / len(OFTEN))


@pytest.mark.parametrize("frame", ["world", "body"])
@pytest.mark.parametrize("seed", range(3))
def test_noise_about_one_axis_is_no_jitter(frame, seed):
    angles = np.random.default_rng(seed).normal(0, 0.02, len(OFTEN))
    exact = make_estimates(TRUTH, OFTEN)
    parts = turn_z(angles), exact.orientations
    noisy = replace(exact, orientations=compose(*parts[:: 1 if frame == "world" else -1]))
    assert measure_clock(noisy, TRUTH, "file").kind == "none"


def test_fewer_than_ten_estimates_are_refused():
    made = Made().make(TRUTH, OFTEN[:9])
    with pytest.raises(RefusedError, match="must have 10 estimates that can be judged, got 9"):
        measure_clock(made, TRUTH, "file")
    before = replace(made, stamps=made.stamps - 10 * SECOND)
    with pytest.raises(RefusedError, match="must have 10 estimates that can be judged, got 0"):
        measure_clock(before, TRUTH, "file")


HIDDEN = [
    ("sleeping", OFTEN, "heading"),  # a turn about the vertical is a delay
    ("sleeping", OFTEN, "world-and-body"),
    ("regular_precession", OFTEN, "world-and-body"),
    ("cusps", np.full(20, SECOND), "none"),  # no rate at one instant
]


@pytest.mark.parametrize(("scene", "stamps", "model"), HIDDEN)
def test_what_a_motion_does_not_show_is_refused(scene, stamps, model):
    truth = scene_truth(scene)
    made = Made(delay=1e-5, noise=NOISE).make(truth, stamps)
    with pytest.raises(RefusedError, match=f"a model that this motion can show, got {model}"):
        measure_clock(made, truth, "file", model)


def test_the_command_prints_a_sentence_or_json(tmp_path, capsys):
    found = Made(delay=2e-3).make(TRUTH, OFTEN)
    path = tmp_path / "estimates.csv"
    path.write_text(write_rows(found, header=("t", "w", "x", "y", "z")))
    assert main(["--clock", str(path), "--scene", "cusps"]) == 0
    text = capsys.readouterr().out
    assert "the stamps of 2000 estimates are late by " in text
    assert main(["--clock", str(path), "--scene", "cusps", "--json"]) == 0
    (clock,) = json.loads(capsys.readouterr().out)
    assert clock["kind"] == "none"
    assert clock["delay"] == pytest.approx(2000, abs=5 * clock["delay_deviation"])
