"""The clock of stamps is found within the noise, and jitter only where there is some."""

import json
from dataclasses import replace

import numpy as np
import pytest
from judge.cases import SECOND, TILT, Made, write_rows

from symtop_ros.judge.clock import measure_clock
from symtop_ros.judge.main import main
from symtop_ros.judge.truth import scene_truth
from symtop_ros.simulation.validation import RefusedError

TRUTH = scene_truth("cusps")
STAMPS = np.arange(SECOND, 6 * SECOND, SECOND // 400)
NOISE = 1e-3  # rad
FASTEST = 140.0  # rad/s, about: the angular velocity of this scene


@pytest.mark.parametrize("made", [Made(noise=NOISE), Made(TILT, noise=NOISE)])
@pytest.mark.parametrize(("delay", "rate"), [(1e-6, 0.0), (0.0, 1e-6), (-40e-6, 25e-6)])
def test_a_delay_and_a_rate_are_found_within_five_deviations(made, delay, rate):
    made = Made(made.world, delay=delay, clock=rate, noise=NOISE)
    clock = measure_clock(made.make(TRUTH, STAMPS), TRUTH, "file", "world")
    # An offset of `Made` grows from the first stamp on; the delay is that in the middle.
    middle = delay + rate * (STAMPS[-1] - STAMPS[0]) / 2e9
    assert abs(clock.delay - 1e6 * middle) < 5 * clock.delay_deviation
    assert abs(clock.rate - 1e6 * rate) < 5 * clock.rate_deviation
    # n stamps over T seconds give a delay to d / sqrt(n) and a rate to sqrt(12) d / (T sqrt(n)),
    # where d is the noise over the angular velocity; twice that for what the rotations take.
    seconds = 1e6 * NOISE / FASTEST / np.sqrt(len(STAMPS))
    assert clock.delay_deviation < 2 * seconds
    assert clock.rate_deviation < 2 * np.sqrt(12) / 5 * seconds


def test_jitter_is_told_from_noise_and_from_a_late_clock_and_noise_is_not_jitter():
    made = Made(delay=-40e-6, clock=1e-5, noise=NOISE)
    # the true times differ from the stamps by noise
    times = STAMPS + np.rint(np.random.default_rng(5).normal(0, 10e-6 * SECOND, len(STAMPS)))
    estimates = replace(made.make(TRUTH, times.astype(np.int64)), stamps=STAMPS)
    clock = measure_clock(estimates, TRUTH, "file")
    assert clock.kind == "jitter"
    # A variance from n estimates has a deviation of sqrt(2 / n), at most sqrt(3) times that here.
    assert abs(clock.jitter - 10) < 10 * 5 * np.sqrt(1.5 / len(STAMPS))

    clock = measure_clock(Made(noise=NOISE).make(TRUTH, STAMPS), TRUTH, "file")
    assert clock.kind == "none"
    assert clock.jitter < 1e6 * NOISE / FASTEST


def test_fewer_than_ten_estimates_are_refused():
    made = Made().make(TRUTH, STAMPS[:9])
    with pytest.raises(RefusedError, match="must have 10 estimates within the run, got 9"):
        measure_clock(made, TRUTH, "file")
    before = replace(made, stamps=made.stamps - 10 * SECOND)
    with pytest.raises(RefusedError, match="must have 10 estimates within the run, got 0"):
        measure_clock(before, TRUTH, "file")


@pytest.mark.parametrize(
    ("scene", "stamps", "model"),
    [
        ("sleeping", STAMPS, "heading"),  # a turn about the vertical is a delay
        ("sleeping", STAMPS, "world-and-body"),
        ("regular_precession", STAMPS, "world-and-body"),
        ("cusps", np.full(20, SECOND), "none"),  # no rate at one instant
    ],
)
def test_what_a_motion_does_not_show_is_refused(scene, stamps, model):
    truth = scene_truth(scene)
    made = Made(delay=1e-5, noise=NOISE).make(truth, stamps)
    with pytest.raises(RefusedError, match=f"a model that this motion can show, got {model}"):
        measure_clock(made, truth, "file", model)


def test_the_command_prints_a_sentence_or_json(tmp_path, capsys):
    found = Made(delay=2e-3).make(TRUTH, STAMPS)
    path = tmp_path / "estimates.csv"
    path.write_text(write_rows(found, header=("t", "w", "x", "y", "z")))
    assert main(["--clock", str(path), "--scene", "cusps"]) == 0
    text = capsys.readouterr().out
    assert "the stamps of 2000 estimates are late by 2000 " in text
    assert main(["--clock", str(path), "--scene", "cusps", "--json"]) == 0
    (clock,) = json.loads(capsys.readouterr().out)
    assert clock["kind"] == "none"
    assert clock["delay"] == pytest.approx(2000, abs=5 * clock["delay_deviation"])
