"""Headline and reason of the page for every kind of motion, compared with theta''."""

import math
import re

import pytest

from symtop_ros.physics import Top, regular_precession_rates, theta_acceleration

IX, IZ, THETA, SPIN = 0.000228, 0.0000572, 0.5, 200.0


def list_starts(Mgl):
    """Starts of every kind: at rest, at the other cusp, steady, and about them."""
    top = Top(IX, IZ, Mgl)
    slow, fast = regular_precession_rates(top, THETA, SPIN)
    rates = [0.0, slow, fast, slow + 1e-9, slow + 1e-4, slow + 1, -3.0, 3 * slow, 100.0]
    if Mgl:
        cosine = math.cos(THETA)  # phi' = 2 Mgl/p_psi, where p_psi has phi' in it
        a, b, c = IZ * cosine, IZ * SPIN, -2 * Mgl
        rates.append((-b + math.sqrt(b * b - 4 * a * c)) / (2 * a))
    starts = [{"theta": THETA, "phi_dot": rate, "psi_dot": SPIN} for rate in rates]
    starts += [{"theta": 2.5, "phi_dot": rate, "psi_dot": -SPIN} for rate in rates]
    starts.append({"theta": THETA, "phi_dot": 0.0, "psi_dot": 0.0})
    for pole in (0.0, math.pi):
        starts.append({"theta": pole, "phi_dot": 0.0, "psi_dot": SPIN})
    starts.append({"theta": THETA, "phi_dot": 0.0, "theta_dot": 2.0, "psi_dot": SPIN})
    # p_psi = p_phi with the energy of the upright top: it comes to rest there after all time
    least = 2 * math.sqrt(IX * abs(Mgl)) / IZ
    starts.append({"theta": THETA, "phi_dot": least * IZ / IX / 2, "psi_dot": 0.1 * least})
    return [{"top": {"Ix": IX, "Iz": IZ, "Mgl": Mgl}, **each} for each in starts]


def find_direction(start):
    """Return where theta' leads at first, or theta'' if theta' is zero, and 0 if nothing moves."""
    if start["theta"] in (0.0, math.pi):
        return 0
    rates = start["theta"], start["phi_dot"], start["psi_dot"]
    change = start.get("theta_dot") or float(theta_acceleration(Top(**start["top"]), *rates))
    # A swing of less than 1e-7 rad is none: it is 2 theta'' divided by the square of 50 rad/s.
    return 0 if abs(change) < 1e-7 * 50**2 / 2 else math.copysign(1, change)


@pytest.mark.wording
@pytest.mark.parametrize("Mgl", [0.068, -0.068, 0.0])
def test_headline_and_reason_of_every_kind_agree_with_the_motion(tab, Mgl):
    starts, kinds = list_starts(Mgl), set()
    for start, (headline, why, kind) in zip(starts, tab.evaluate("sayStarts", starts), strict=True):
        kinds.add(kind)
        direction = find_direction(start)
        verb = {1: "falls", -1: "rises", 0: "keeps its tilt"}[direction]
        assert re.search(rf": The (top|axis) {verb}\b", why), (start, why)
        words = re.findall("falls|rises", headline)  # of no direction of its own
        assert words in ([], [verb]), (start, headline, why)
        is_steady = "precesses steadily" in headline
        assert is_steady == (kind == "regular" and start["phi_dot"] != 0), (start, headline)
        assert direction == 0 or not is_steady
        if direction == 0:
            assert "constant at" in headline or "on the vertical" in headline
            assert "will stay at" in why
        if "in cusps" in headline or "in loops" in headline or "in waves" in headline:
            assert "with its tilt between" in headline
            assert "will stay between" in why
    expected = {"regular", "sleeping"}
    expected |= {"cusps", "looping", "unidirectional", "through the pole"} if Mgl else set()
    assert expected <= kinds, kinds
