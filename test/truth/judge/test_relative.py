"""The relative pose error, against evo's own numbers, and outliers with what they hide."""

import json
import re

import numpy as np
import pytest
from drawn import Numbers
from trials import choose
from truth.judge.cases import SECOND, Made, heading, write_rows

from symtop_ros.base.arrays import compose
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.topics.estimates import Estimates

SCENES = "cusps", "looping", "hanging", "disc", "conical_pendulum"
STEP = SECOND // 100
LAGS = 10, 100  # estimates
TUM = {"separator": " ", "order": (1, 2, 3, 0), "middle": "000"}


def make_file(number):
    """Return the exact estimates of a scene, those with a drift, a delay and noise, and a lag."""
    truth = scene_truth(SCENES[number % 5])
    stamps = SECOND + np.arange(300) * STEP
    q, rates, _ = truth.states_at(stamps)
    exact = Estimates.of(stamps, q, rates)
    made = Made(drift=0.05 * (number + 1), delay=1e-3 * (number % 3), world=heading(0.3))
    wrong = made.make(truth, stamps).orientations
    vectors = 2.0 ** -(5 + number % 4) * Numbers(number).normals(300, 3) / 2
    noise = np.column_stack((np.ones(300), vectors))
    return exact, Estimates.of(stamps, compose(wrong, noise), rates), LAGS[number // 5]


def write_files(number, folder):
    """Write the exact states and the estimates as TUM, and return the lag in estimates."""
    exact, wrong, lag = make_file(number)
    for name, each in (("exact", exact), ("wrong", wrong)):
        (folder / f"{name}.tum").write_text(write_rows(each, **TUM))
    return lag


# rms, mean and largest error (rad) that evo 1.38.1 printed for these files:
# evo_rpe tum exact.tum wrong.tum --delta LAG --delta_unit f --all_pairs --pose_relation angle_rad
EVO = [
    (0.075332, 0.068937, 0.160412),
    (0.097921, 0.091754, 0.181534),
    (0.075214, 0.074371, 0.103572),
    (0.022006, 0.021430, 0.037722),
    (0.084086, 0.076700, 0.191493),
    (0.322549, 0.321280, 0.393939),
    (0.350275, 0.350108, 0.381534),
    (0.401756, 0.401713, 0.414772),
    (0.487332, 0.485045, 0.598520),
    (0.502147, 0.501595, 0.569461),
]


@pytest.mark.parametrize("number", range(10))
def test_the_relative_error_is_that_of_evo(number, tmp_path, capsys):
    lag = write_files(number, tmp_path)
    options = ["--scene", SCENES[number % 5], "--estimates", str(tmp_path / "wrong.tum")]
    options += ["--aligned", "none", "--rpe", f"{10 * lag}ms"]
    assert main([*options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["relative"]
    assert (found["lag"], found["pairs"]) == (lag / 100, 300 - lag)
    # evo prints six decimals
    mine = [found[name] for name in ("rms", "mean", "p100")]
    assert mine == pytest.approx(EVO[number], abs=0.51e-6)
    assert main(options) == 0
    row = re.search(r"^RPE, (\S+) s \(rad\) +(.*)$", capsys.readouterr().out, re.M)
    assert float(row[1]) == lag / 100
    assert [float(each) for each in row[2].split()][:2] == pytest.approx(mine[:2], rel=5.1e-3)


BAD_LAGS = "1", "s", "0s", "-1s", "1h", "nan"


@pytest.mark.parametrize("text", BAD_LAGS)
def test_a_lag_needs_a_unit(text, capsys):
    with pytest.raises(SystemExit):
        main(["--scene", "cusps", "--estimates", "x.csv", f"--rpe={text}"])
    assert f"--rpe: must be a time such as 1s or 50ms, got {text}" in capsys.readouterr().err


@pytest.mark.slow
def test_a_lag_that_is_longer_than_the_run_is_refused(tmp_path, capsys):
    write_files(0, tmp_path)
    options = ["--scene", "cusps", "--estimates", str(tmp_path / "wrong.tum"), "--rpe", "5s"]
    assert main(options) == 1
    assert capsys.readouterr().err == "top_judge: --rpe must be within the run of 2.99 s, got 5 s\n"


TRUTH = scene_truth("cusps")
STAMPS = SECOND + np.arange(1000) * (SECOND // 200)


def spoil(made, count, seed=1):
    """Return estimates of which so many are any attitude."""
    found = made.make(TRUTH, STAMPS, seed)
    random = Numbers(seed)
    places = random.sample(range(1, len(STAMPS)), count)
    q = found.orientations.copy()
    q[places] = random.quaternions(count)
    return Estimates.of(STAMPS, q), set(places)


SEARCHED = pytest.param(50, None, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("count", "model"), [(0, "none+delay"), (1, "none+delay"), (50, "none+delay"), SEARCHED]
)
def test_outliers_are_counted_and_may_be_left_out(count, model):
    estimates, _ = spoil(Made(delay=12.3457e-3, noise=1e-3), count)
    plain = judge(estimates, TRUTH, "x", aligned="none+delay")
    assert plain.outliers == pytest.approx(count, abs=count // 10)
    counted = re.search(r"^outliers: (\d+) estimate", plain.format(), re.M)
    assert (int(counted[1]) if counted else 0) == plain.outliers
    robust = judge(estimates, TRUTH, "x", aligned=model, robust=True)
    assert robust.outliers == count
    assert f"outliers: {count} estimate" in robust.format()
    cause = robust.fitted or robust.found.best
    (deviation,) = cause.deviations
    assert abs(cause.offset.delay - 12.3457e-3) < 4.5 * deviation
    # that of the noise of the others
    assert deviation == pytest.approx(1.75e-7, rel=0.15)
    assert robust.facts()["robust"]
    assert robust.facts()["outliers"] == count


@pytest.mark.parametrize("model", choose(("none", None), ("none",)))
@pytest.mark.parametrize("axes", [(1, 1, 1), (0, 0, 1)])
def test_noise_has_no_outliers(axes, model):
    exact = TRUTH.states_at(STAMPS)[0]
    vectors = 1e-3 * Numbers(7).normals(len(STAMPS), 3) * axes
    noise = np.column_stack((np.ones(len(STAMPS)), vectors / 2))
    for q in (compose(exact, noise), compose(noise, exact)):
        assert judge(Estimates.of(STAMPS, q), TRUTH, "x", aligned=model).outliers == 0
