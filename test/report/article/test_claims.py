import re

import numpy as np
import pytest

from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.report.article import on_momentum, on_nutation, on_rates
from symtop_ros.report.article.claim import Claim, markdown, table
from symtop_ros.report.article.claims import claims
from symtop_ros.report.article.departure import Departure
from symtop_ros.report.article.difference import slope
from symtop_ros.report.article.motions import FAST, RATES, SLOW, TOP, Rate, cusps, seven, start

HEAVIER = Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)
WEIGHTLESS = Top(TOP.Ix, TOP.Iz, 0.0)
RUBBING = motion(TOP, start(0.0), Friction(axial=2e-6, transverse=1e-5))


@pytest.fixture(scope="module")
def found():
    return claims()


def test_every_claim_holds(found):
    assert [claim for claim in found if not claim.holds] == []
    assert len(found) == 22


def test_every_claim_is_a_sentence_with_a_number(found):
    assert len({claim.sentence for claim in found}) == len(found)
    for claim in found:
        assert claim.sentence.endswith(".")
        assert re.search(r"\d", claim.measured)


def test_of_a_top_one_percent_heavier_the_roots_are_not_as_printed():
    failed = {claim.sentence for claim in claims(HEAVIER) if not claim.holds}
    assert sum("stays" in sentence for sentence in failed) == 2
    assert any("phi' = 6.50 and 69.8" in sentence for sentence in failed)


def test_a_top_too_heavy_for_regular_precession_fails_without_an_error():
    found = claims(Top(TOP.Ix, TOP.Iz, 0.6))
    assert not found[0].holds
    assert [claim.holds for claim in found if "Perry" in claim.sentence] == [False, False, True]


@pytest.mark.parametrize("follows", ["rises", "falls", "stays"])
@pytest.mark.parametrize("rate", RATES, ids=lambda rate: f"{rate.phi_dot:.3g}")
def test_a_rate_holds_only_with_what_really_follows(rate, follows):
    claim = on_rates.rate_decides(TOP, Rate(rate.phi_dot, rate.place, follows))
    assert claim.holds == (follows == rate.follows)


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("root", [SLOW, FAST])
def test_a_rate_a_little_off_a_root_does_not_stay(root, off):
    for sign in (-1, 1):
        expected = "rises" if sign == (1 if root == SLOW else -1) else "falls"
        departure = Departure.of(TOP, start(root * (1 + sign * off)))
        assert departure.directions[0] == departure.directions[2] == expected


@pytest.mark.parametrize("name", ["L_z (along the axis)", "The energy E"])
def test_friction_ends_the_constants(name):
    assert on_momentum.is_constant(name, [cusps()]).holds
    assert not on_momentum.is_constant(name, [cusps(), RUBBING]).holds


def test_a_torque_of_another_kind_is_not_along_the_line_of_nodes():
    pushed = motion(TOP, start(0.0), torque=(0.0, 0.0, 1e-4))
    assert not on_momentum.torque_is_along_the_line_of_nodes(pushed).holds


def test_under_friction_the_momentum_changes_by_more_than_gravity():
    claim = on_momentum.momentum_changes_by_gravity
    assert claim(cusps()).holds
    assert not claim(RUBBING).holds


def test_under_friction_the_articles_equations_do_not_hold():
    assert not on_momentum.equations_hold(RUBBING).holds


def test_an_attitude_that_turns_otherwise_is_found_out(monkeypatch):
    path, at = cusps(), cusps().at
    claim = on_momentum.attitude_turns_with_the_angular_velocity
    assert claim(path).holds
    monkeypatch.setattr(
        path, "at", lambda t: State(at(t).orientation, at(t).angular_velocity + 1e-6)
    )
    assert not claim(path).holds


def test_without_weight_the_momentum_does_not_swing():
    nodding = motion(WEIGHTLESS, start(9.0))
    assert not on_nutation.momentum_swings_with_the_tilt([nodding]).holds


def test_only_cusps_stop_the_precession():
    claim = on_nutation.precession_stops_at_the_cusps
    assert claim(cusps()).holds
    waves = [path for path in seven() if path.kind == "unidirectional"]
    assert [claim(path).holds for path in waves] == [False] * 4
    assert not claim(motion(TOP, start(-8.0))).holds  # loops


def test_counted_maxima_leave_out_rounding():
    t = np.linspace(0.0, 10.25, 5000)
    assert on_nutation.maxima(3.0 - np.cos(2 * np.pi * t)) == 10
    assert on_nutation.maxima(3.0 + 1e-14 * np.cos(2 * np.pi * t)) == 0


def test_a_slope_is_as_good_as_it_says():
    times = np.linspace(0.0, 1.0, 50)
    found = slope(lambda t: np.sin(100 * t), times)
    assert np.abs(found.values - 100 * np.cos(100 * times)).max() <= 2 * found.error < 1e-8


def test_tables_show_every_claim_and_count_them():
    two = [Claim("It is so.", "1 | 2 L_z'", holds=True), Claim("It is not.", "3", holds=False)]
    for text in (table(two), markdown(two)):
        assert "1 of 2 claims hold." in text
        assert text.index("It is so.") < text.index("pass") or "pass It is so." in text
        assert "FAIL" in text
    assert r"1 \| 2 L\_z'" in markdown(two)
