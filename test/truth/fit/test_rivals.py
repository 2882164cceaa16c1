"""A kick and friction are found in records of bodies that know nothing of the fit."""

import re

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import make_axis, make_noisy

from symtop_ros.truth.fit import fit_motion, make_record
from symtop_ros.truth.fit.check import Check
from symtop_ros.truth.fit.report import Report
from symtop_ros.truth.fit.rivals import find_rivals
from workshop.records.bodies import Body, Kick
from workshop.records.draws import AXES, RATES, SECONDS, Start, draw_record

FAR = 5.0  # deviations; a normal number is farther once in two million
START = Start(Body((1.0, 1.0, 0.5), 120.0), 0.75, 0.5, (0.5, 3.5, 60.0))
CHANGE = (0.09375, -0.125, 0.0)  # rad/s, in the body: 0.15625 in all


def observe(kind, start=START, kicks=(), seed=1):
    """Return the report of points of the axis, or of rates, of an own body."""
    rate = 120.0 if kind == "axis" else 200.0
    times = np.arange(round(SECONDS * rate)) / rate
    turned, rates = start.follow(kicks).at(times)
    exact, sigma = (turned[:, :, 2], AXES) if kind == "axis" else (rates, RATES)
    noise = sigma * Numbers(f"rivals {seed}").normals(*exact.shape)
    record = make_record(times, exact + noise, kind)
    return Report.compare("record", len(times), fit_motion(record), {})


def read(report):
    """Return the numbers of a report with their deviations, by the names that stand there."""
    rows = re.findall(r"^  (\S.*?)  +(\S+) \+- (\S+)", report.format(), re.M)
    return {name: (float(value), float(deviation)) for name, value, deviation in rows}


def assert_near(rows, name, truth):
    value, deviation = rows[name]
    assert abs(value - truth) < FAR * deviation, (name, value, deviation)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["axis", "rates"])
def test_a_slight_kick_is_named_with_its_place_and_its_size(kind):
    report = observe(kind, kicks=(Kick(1.375, CHANGE),))
    rows = read(report)
    assert (report.verdict, report.rivals[0].kind) == ("fails", "kick")
    assert_near(rows, "Mgl/Ix", 120.0)
    assert_near(rows, "p_psi/Ix", 30.0)
    assert_near(rows, "kick after", 1.375)
    assert_near(rows, "change of the rates", 0.15625)
    assert rows["kick after"][1] < 0.02
    assert "does not hold without a kick" in report.write_verdict()


def lose(dry, linear):
    """Return a start that loses parts of its spin in a record."""
    Iz, spin = 0.5, 60.0
    torque, rate = dry * Iz * spin / SECONDS, linear / SECONDS
    body = Body((1.0, 1.0, Iz), 120.0, dry=torque, linear=(rate * Iz, rate / 4))
    return Start(body, 0.75, 0.5, START.rates)


@pytest.mark.slow
def test_linear_friction_that_was_not_looked_for_is_found():
    report = observe("rates", lose(0.0, 0.05))
    rows = read(report)
    assert report.rivals[0].kind == "friction"
    assert "does not hold without friction" in report.write_verdict()
    assert_near(rows, "axial/Iz", 0.05 / SECONDS)
    assert_near(rows, "Mgl/Ix", 120.0)
    assert_near(rows, "spin (omega_z)", 60.0)


@pytest.mark.slow
def test_dry_friction_is_no_push():
    """A quarter of the spin is lost, so that it is seen not to be lost as by linear friction."""
    report = observe("rates", lose(0.25, 0.0))
    text = report.write_verdict()
    assert "the top loses spin, but linear friction does not explain the loss" in text
    assert "kick" not in text.split(",")[0]
    assert "axial/Iz" in {each.name for each in report.values}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_noise_that_lasts_is_neither_a_kick_nor_friction(seed):
    times = np.arange(240) / 128
    draw = Numbers(f"lasting noise {seed}")
    noise = draw.normals(len(times), 3)
    for row in range(1, len(noise)):
        noise[row] = 0.8 * noise[row - 1] + 0.6 * noise[row]
    fit = fit_motion(make_record(times, make_axis(sigma=0.0) + 2.0**-8 * noise, "axis"))
    assert len(fit.noise.partial) > 0
    assert find_rivals(fit, Check(fit)) == []


def test_white_noise_is_not_looked_at_again():
    record = make_noisy("axis", make_axis(sigma=0.0), 2.0**-8)
    fit = fit_motion(record)
    assert Check(fit).verdict == "holds"
    assert find_rivals(fit, Check(fit)) == []


@pytest.mark.long
def test_of_many_records_a_kick_has_the_place_and_the_size_that_it_had():
    """One that leaves white noise changes the numbers by no more than noise does."""
    pulls, found = [], 0
    for seed in range(40):
        drawn = draw_record("kick, axis", seed)
        times, *seen = drawn.columns.values()
        fit = fit_motion(make_record(times, np.stack(seen, axis=1), "axis"))
        rivals = find_rivals(fit, Check(fit))
        found += bool(rivals)
        assert [each.kind for each in rivals[:1]] == ["kick"][: len(rivals)]
        report = Report("record", len(times), rivals[0].fit if rivals else fit, {})
        values = {each.name: each for each in report.values}
        pulls += [
            (values[name].value - true) / values[name].deviation
            for name, true in drawn.truth.items()
        ]
    assert found >= 35
    # 200 pulls: their root mean square is 1 but for 0.05, and for 0.2 if five of them were one
    assert 0.8 < np.sqrt(np.mean(np.square(pulls))) < 1.25
