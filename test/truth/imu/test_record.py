"""Measurements of the sensor, compared with 50 digits."""

import csv
import json
from dataclasses import fields, replace
from itertools import chain

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.test_body import differentiate
from physics.tops import ARTICLE, CUSPS, EPS, Case, cross, turn

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.replay.main import main as replay
from symtop_ros.truth.imu import Imu, Magnetometer, record_imu
from symtop_ros.truth.imu.files import write_table
from symtop_ros.truth.imu.main import main
from symtop_ros.truth.judge.main import main as judge

MOTION = Motion(ARTICLE, CUSPS)
GRAVITY = 9.81
PLACE = (0.01, -0.005, 0.02)
SENSOR = Imu(PLACE, rate=1000.0)


def state_at(t):
    return Case(ARTICLE, CUSPS, t).exact


def force_at(t):
    """Specific force in the body frame, from differences of places with 50 digits."""
    q, _ = state_at(t)
    with mp.workdps(50):
        acceleration = differentiate(lambda dt: state_at(mpf(t) + dt)[0], PLACE, 2.0**-21)
        total = [*acceleration[:2], acceleration[2] + mpf(GRAVITY)]
        return turn((q[0], -q[1], -q[2], -q[3]), total)


@pytest.mark.parametrize("sample", [0, 777, 19_999])
def test_the_record_agrees_with_differences_of_50_digits(sample):
    record = record_imu(MOTION, SENSOR, 20.0)
    with mp.workdps(50):
        t = mpf(int(record.stamps[sample])) / 10**9
    q, omega = state_at(t)
    pairs = (
        (record.orientations, q),
        (record.positions, turn(q, [mpf(p) for p in PLACE])),
        (record.velocities, turn(q, cross(omega, [mpf(p) for p in PLACE]))),
        (record.rates, omega),
        (record.forces, force_at(t)),
    )
    for ours, exact in pairs:
        size = max(abs(float(x)) for x in exact)
        error = np.abs(ours[sample] - [float(x) for x in exact]).max() / size
        assert error < 4e-16  # the rounding of the state, and of a product


RATES = [(1000.0, 9), pytest.param(30.0, 22, marks=pytest.mark.long)]  # 1e-18 of the integrals


@pytest.mark.slow
@pytest.mark.parametrize(("rate", "points"), RATES)
def test_means_are_the_integrals_over_the_interval(rate, points):
    record = record_imu(MOTION, replace(SENSOR, rate=rate), 1.0, average=True)
    k = 7
    points, weights = np.polynomial.legendre.leggauss(points)
    mean = np.zeros(6)
    for point, weight in zip(points.tolist(), weights.tolist(), strict=True):
        with mp.workdps(50):
            t = mpf(int(record.stamps[k])) / 10**9 + (mpf(point) - 1) / (2 * mpf(rate))
        values = [*state_at(t)[1], *force_at(t)]
        mean += weight / 2 * np.array([float(x) for x in values])
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(record.means[:, part]).max()
        # the same, of a sum with positive weights
        assert np.abs(record.means[k, part] - mean[part]).max() / scale < 4e-16
    assert (record.measured == record.means).all()


# A pendulum that is slow at the stamps and fast between them, one that spins, and driven tops.
SLOW_AT_STAMPS = Motion(Top(1.0, 0.5, 100.0), State.from_euler(theta=0.1))
SWINGS = {
    "pendulum": SLOW_AT_STAMPS,
    "spinning": Motion(Top(1.0, 0.5, 100.0), State.from_euler(theta=0.1, psi_dot=4.0)),
    "hanging": Motion(Top(1.0, 0.5, -100.0), State.from_euler(theta=3.0, phi_dot=0.1)),
    "friction": Motion(Top(1.0, 0.5, 2.0), State.from_euler(theta=0.1), Friction(0.01, 0.02)),
    "torque": Motion(Top(1.0, 0.5, 1.0), State.from_euler(theta=1.0), torque=(0.1, 0.0, 0.02)),
}


@pytest.mark.parametrize("name", SWINGS)
def test_the_mean_of_a_long_interval_is_that_of_its_parts(name):
    # 64 parts each: in a part the top turns little, so that no choice of points can be wrong.
    long = record_imu(SWINGS[name], replace(SENSOR, rate=0.125), 24.0, average=True)
    short = record_imu(SWINGS[name], replace(SENSOR, rate=8.0), 24.0, average=True)
    means = short.means[1:129].reshape(2, 64, 6).mean(axis=1)
    largest = np.abs(short.forces).max(), np.abs(short.rates).max()
    for part, size in ((slice(3, 6), largest[0]), (slice(0, 3), largest[1])):
        # the rounding of states, of products, and of the means of 64
        assert np.abs(long.means[1:, part] - means[:, part]).max() < 32 * EPS * size


@pytest.mark.slow
def test_a_sensor_slower_than_the_top_has_its_mean_force():
    record = record_imu(SLOW_AT_STAMPS, Imu(PLACE, rate=0.114), 20.0, average=True)
    assert record.means[0, 5] == pytest.approx(3.50202489, abs=1e-8)


def test_means_of_too_many_states_are_refused():
    refusal = "number of states for the means must be at most 1e\\+09, got"
    with pytest.raises(RefusedError, match=refusal):
        record_imu(MOTION, replace(SENSOR, rate=1e-3), 2e7, average=True)


SHORT = "--scene", "cusps", "--seconds", "0.5", "--rate", "500"
MOUNTED = "--position", "0", "0", "0.02", "--orientation", "0.5", "0.5", "0.5", "0.5"
NOISY = "--noise", "consumer", "--seed", "7"


def read(path):
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    return head, rows


def test_a_log_is_judged_and_computed_again(tmp_path, capsys):
    path = tmp_path / "run.mcap"
    assert main([*SHORT, *MOUNTED, *NOISY, "--average", "-o", str(path)]) == 0
    assert [each.name for each in tmp_path.iterdir()] == ["run.mcap"]
    for topic in ("imu", "imu_exact", "imu_average", "orientation"):
        # exact attitudes: the products with the mount are the same
        assert judge([str(path), "--topic", f"/top/{topic}", "--max-error", "1e-15"]) == 0
    capsys.readouterr()
    assert replay([str(path), "--check"]) == 0
    assert "250 samples, largest difference 0" in capsys.readouterr().out


def test_a_table_is_judged_with_its_events(tmp_path, capsys):
    path = tmp_path / "run.csv"
    assert main([*SHORT, *MOUNTED, *NOISY, "-o", str(path)]) == 0
    arguments = [str(tmp_path / "run.json"), "--estimates", str(path), "--json"]
    capsys.readouterr()
    assert judge([*arguments, "--attitude-of", "sensor"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["estimates"], facts["angular_velocity"]["p100"]) == (250, 0.0)
    assert facts["attitude"]["p100"] < 1e-15  # numbers are written so that they read back
    head, rows = read(path)
    assert head[:5] == ["stamp", "w", "x", "y", "z"]
    assert len(rows) == 250
    assert {len(row) for row in rows} == {len(head)}


def test_the_folder_has_the_columns_of_euroc_and_tum(tmp_path):
    assert main([*SHORT, *NOISY, "-o", str(tmp_path / "run")]) == 0
    head, rows = read(tmp_path / "run/imu0/data.csv")
    assert head[0] == "#timestamp [ns]"
    assert (len(head), len(rows), rows[1][0]) == (7, 250, "2000000")
    head, truth = read(tmp_path / "run/state_groundtruth_estimate0/data.csv")
    assert (len(head), len(truth)) == (17, 250)
    poses = np.loadtxt(tmp_path / "run/poses.tum")
    assert poses.shape == (250, 8)
    exact = np.array(truth, dtype=float)
    assert (poses[:, [7, 4, 5, 6]] == exact[:, 4:8]).all()
    events = json.loads((tmp_path / "run/events.json").read_text())
    assert events["end"] == int(rows[-1][0])


def test_a_magnetometer_is_in_every_form_of_the_record(tmp_path, capsys):
    field = "--magnetic-field=.1e-4,2e-5,-4e-5"
    for name in ("run.csv", "run.mcap", "run"):
        assert main([*SHORT, *MOUNTED, *NOISY, field, "-o", str(tmp_path / name)]) == 0
    head, rows = read(tmp_path / "run.csv")
    assert head[-6:] == ["mx", "my", "mz", "measured_mx", "measured_my", "measured_mz"]
    table = np.array(rows, dtype=float)
    lengths = np.linalg.norm(table[:, -6:-3], axis=1)
    assert lengths == pytest.approx(21**0.5 * 1e-5, rel=1e-15)
    head, measured = read(tmp_path / "run/mag0/data.csv")
    assert head[1] == "m_S_x [T]"
    assert (np.array(measured, dtype=float)[:, 1:] == table[:, -3:]).all()
    assert "magnetometer_noise_density: 6.7e-08" in (tmp_path / "run/mag0/sensor.yaml").read_text()
    capsys.readouterr()
    assert replay([str(tmp_path / "run.mcap"), "--check"]) == 0
    found = capsys.readouterr().out
    assert "/top/magnetic_field               250 samples, largest difference 0" in found


def test_a_sensor_with_limits_is_in_every_form_of_the_record(tmp_path, capsys):
    limits = "--range", "34.9", "150", "--resolution", "0.001"
    for name in ("run.csv", "run.mcap", "run"):
        assert main([*SHORT, *MOUNTED, *NOISY, *limits, "-o", str(tmp_path / name)]) == 0
    head, rows = read(tmp_path / "run.csv")
    table = np.array(rows, dtype=float)
    spins = np.abs(table[:, head.index("wy")])  # the mount turns the axis to y
    assert spins.min() > 100
    shown = table[:, head.index("measured_wx") :][:, :3]
    assert (np.abs(shown[:, 1]) == 34.9).all()
    # a product of a whole number and 0.001 is written with all its digits
    assert np.abs(shown - np.round(shown, 3)).max() < 1e-14
    assert "gyroscope_range: 34.9" in (tmp_path / "run/imu0/sensor.yaml").read_text()
    capsys.readouterr()
    assert replay([str(tmp_path / "run.mcap"), "--check"]) == 0
    assert "/top/imu                          250 samples" in capsys.readouterr().out
    assert main([*SHORT, "--range", "1", "2", "3", "-o", str(tmp_path / "no.csv")]) == 1
    refusal = "top_imu: --range must be one number or two, got 3\n"
    assert capsys.readouterr().err == refusal


def test_noise_may_be_in_a_file_of_kalibr(tmp_path, capsys):
    noise = tmp_path / "imu.yaml"
    noise.write_text("rostopic: /imu0\naccelerometer_noise_density: 0.01\nupdate_rate: 200.0\n")
    assert main([*SHORT, "--noise", str(noise), "-o", str(tmp_path / "run.csv")]) == 0
    _, rows = read(tmp_path / "run.csv")
    table = np.array(rows, dtype=float)
    rates = table[:, -6:-3] - table[:, -12:-9]
    forces = table[:, -3:] - table[:, -9:-6]
    assert not rates.any()
    # 750 normal numbers: 2.6 %, four sigma
    assert forces.std() == pytest.approx(0.01 * np.sqrt(500.0), rel=0.11)
    noise.write_text("- 1\n")
    assert main(["--noise", str(noise), "-o", str(tmp_path / "run.csv")]) == 1
    assert capsys.readouterr().err.startswith("top_imu: --noise must be consumer or YAML")


def test_a_log_that_cannot_be_written_is_named_as_it_was_given(tmp_path, capsys):
    path = tmp_path / "missing/x.mcap"
    assert main([*SHORT, "-o", str(path)]) == 1
    assert capsys.readouterr().err.startswith(f"top_imu: cannot write {path}: ")


# The columns of each field that a table has; what another file has, or the event, is named below.
INERTIAL = ("wx", "wy", "wz", "fx", "fy", "fz")
COLUMNS = {
    "orientations": ("w", "x", "y", "z"),
    "positions": ("px", "py", "pz"),
    "velocities": ("vx", "vy", "vz"),
    "rates": INERTIAL[:3],
    "forces": INERTIAL[3:],
    "means": tuple(f"mean_{name}" for name in INERTIAL),
    "measured": tuple(f"measured_{name}" for name in INERTIAL),
    "fields": ("mx", "my", "mz"),
    "measured_fields": ("measured_mx", "measured_my", "measured_mz"),
}
ELSEWHERE = {"imu", "stamps", "attitudes", "biases", "event"}


def test_a_table_has_every_field_of_the_record_under_its_name(tmp_path):
    sensor = replace(SENSOR, magnetometer=Magnetometer())
    record = record_imu(MOTION, sensor, 0.1, average=True)
    assert {field.name for field in fields(record)} == {*COLUMNS, *ELSEWHERE}
    write_table(record, tmp_path / "run.csv")
    head, rows = read(tmp_path / "run.csv")
    table = {name: [row[k] for row in rows] for k, name in enumerate(head)}
    assert set(table) == {"stamp", *chain(*COLUMNS.values())}
    for field, names in COLUMNS.items():
        written = np.array([table[name] for name in names], float).T
        assert np.array_equal(written, getattr(record, field)), field
