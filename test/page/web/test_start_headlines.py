"""Headlines on starts, against what one sees of the sampled motion."""

import math
import re

import numpy as np
import pytest
from drawn import PI, Numbers
from physics.tops import find_roots
from trials import trials

from symtop_ros.physics import Motion, State, Top

SAMPLES = 4097  # of a nutation
SEEN_RATE = (
    0.01  # of the largest phi': what is called loops or waves has more of it (docs/panel.md)
)
# phi' at the turning points is missed by at most its change in half a step: its slope is below
# pi/SAMPLES of its range, squared, as it is extreme there or next to it; but for narrow loops next
# to the vertical, which are left out.
SAMPLED = 1e-3
MOVES = {
    "to the eye": r"precesses in cusps, to the eye",
    "cusps": r"precesses in cusps and comes to rest at each",
    "loops": r"precesses in loops",
    "waves": r"precesses in waves",
    "steady": r"precesses steadily",
}


def draw_starts(count):
    """Starts next to cusps, at roots, and somewhere else, of tops of either sign of Mgl."""
    rng = Numbers("headlines of starts")
    for _ in range(count):
        Ix, unit = rng.power(-4, -1), rng.power(0, 1.5)
        Iz = Ix * rng.choice([rng.uniform(0.05, 1.0), rng.uniform(1.0, 2.0)])
        top = {"Ix": Ix, "Iz": Iz, "Mgl": rng.choice([1, -1]) * Ix * unit * unit}
        theta, spin = rng.uniform(0.3, 2.8), rng.uniform(-9, 9) * Ix / Iz * unit
        roots = find_roots(Top(**top), theta, spin)
        near = rng.choice([-1, 1]) * rng.power(-9, 0) * unit
        rate = rng.choice([near, near, rng.uniform(-3, 3) * unit, *roots, 0.0])
        yield {"top": top, "theta": theta, "phi_dot": rate, "psi_dot": spin}


def sample_rates(start):
    """Return phi' over a nutation, with its ends, and the range of tilts."""
    angles = {name: start[name] for name in ("theta", "phi_dot", "psi_dot")}
    motion = Motion(Top(**start["top"]), State.from_euler(**angles))
    period = motion.nutation_period
    times = np.linspace(0.0, period if math.isfinite(period) else 1.0, SAMPLES)
    states = motion.at(times)
    theta = 2 * np.arcsin(np.minimum(np.hypot(*states.orientation[:, 1:3].T), 1.0))
    return states.euler_rates.phi_dot, theta


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(60, 4000))
def test_loops_waves_and_cusps_are_what_the_precession_does(tab, count):
    starts = list(draw_starts(count))
    heard = set()
    for start, (headline, *_) in zip(starts, tab.evaluate("sayStarts", starts), strict=True):
        said = [name for name, words in MOVES.items() if re.search(words, headline)]
        if not said:
            continue
        (name,) = said
        rates, theta = sample_rates(start)
        if np.sin(theta).min() < 0.05:
            continue
        check_move(name, rates, theta)
        heard.add(name)
    assert heard == {*MOVES}


def check_move(name, rates, theta):
    """Check how a top is said to move by phi' and theta over a nutation."""
    slowest, fastest = sorted(map(abs, (rates.min(), rates.max())))
    share = slowest / fastest  # of phi' at one turning point, in that at the other
    reverses = rates.min() * rates.max() < 0
    if name == "steady":
        assert np.ptp(theta) < 1e-3
        assert np.ptp(rates) < 1e-3 * fastest
    elif name in ("loops", "waves"):
        assert reverses == (name == "loops")
        assert share > SEEN_RATE - SAMPLED
    else:
        assert share < SEEN_RATE + SAMPLED


@pytest.mark.wording
@pytest.mark.parametrize(("Mgl", "theta", "name"), [(0.068, 0.0, "top"), (-0.068, PI, "axis")])
def test_an_unstable_rest_on_the_vertical_is_said_with_how_far_it_may_go(tab, Mgl, theta, name):
    top = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": Mgl}
    starts = [{"top": top, "theta": theta, "phi_dot": 0.0, "psi_dot": spin} for spin in (130, 140)]
    (falls, *_), (sleeps, *_) = tab.evaluate("sayStarts", starts)
    touched = State.from_euler(theta=abs(theta - 1e-7), psi_dot=130.0)
    low, high = Motion(Top(**top), touched).turning_angles
    reached = high if Mgl > 0 else low
    words = f"The {name} sleeps on the vertical and is unstable there: the smallest disturbance"
    assert falls == f"{words} makes it swing out to theta = {reached:.3f} rad."
    assert "unstable" not in sleeps
