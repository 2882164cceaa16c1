"""Write the reference motions of the report to 25 digits, by the reference.

Run it by hand after a change: PYTHONPATH=.:test python test/speed/write_reference.py
"""

from __future__ import annotations

import json
import lzma
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mpmath import mp
from physics.driven_families import DrivenCase, list_cases

from symtop_ros.physics import Friction, State, Top, regular_precession_rates
from symtop_ros.physics.reference import ClosedForm, Inputs, Series
from workshop.article.motions import RATES, THETA, TOP, start
from workshop.speed.reference import FILE, FRICTION
from workshop.testset.exact import error_and_limit

TIMES = [0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6]  # s
DRIVEN_TIMES = [0.1, 1.0, 10.0]
DIGITS = 25
STEPS = [10.0**-k for k in range(1, 16, 2)]
DISC = Top(Ix=0.001, Iz=0.0019, Mgl=-0.05)
Case = tuple[str, float, Top, State, float]  # family, distance, top, start, and time in s


def article() -> Iterator[dict[str, Any]]:
    """Yield the article's seven motions, two next to a pole, and its cusps under friction."""
    for rate in (0.0, *(rate.phi_dot for rate in RATES)):
        name = f"phi' = {rate:.3g} rad/s" if rate else "cusps"
        yield entry(name, TOP, start(rate), TIMES)
    yield entry("unstable sleeper", TOP, State.from_euler(theta=0.001, psi_dot=100.0), TIMES)
    rising = State((0.5, 0.5, 0.5, 0.5), (-1.0, 0.0, 0.0))
    yield entry("separatrix", Top(1.0, 0.5, 0.5), rising, TIMES[:3])  # at rest upright in the end
    yield entry("cusps with friction", TOP, start(0.0), DRIVEN_TIMES, FRICTION)


def hard_cases() -> Iterator[Case]:
    """Yield families that approach a singular case in steps, and the case itself."""
    for small in (*STEPS, 0.0):
        for pole, theta in (("upright", small), ("hanging", math.pi - small)):
            yield f"tilt from {pole}", small, TOP, State.from_euler(theta=theta, psi_dot=200.0), 10
        for side, sign in (("above", 1), ("below", -1)):
            spin = TOP.critical_spin * (1 + sign * small)
            slow = State.from_euler(theta=1e-4, psi=0.7, psi_dot=spin)
            yield f"spin {side} critical, tilt 1e-4", small, TOP, slow, 3
            body = Top(0.001, 0.001 * (1 + sign * small), 0.05)
            tumbling = State.from_euler(theta=0.8, theta_dot=2.0, phi_dot=5.0, psi_dot=150.0)
            yield f"Iz {side} Ix, relative", small, body, tumbling, 40
        for pole in (1, -1):
            omega = (0.3, pole * (2.0 + 2 * small), 4.0)
            through = State((0.5, 0.5, 0.5, 0.5), omega)
            yield f"p_phi from {pole:+d} p_psi, relative", small, Top(1.0, 0.5, 3.0), through, 10
        flat = State.from_euler(theta=math.pi / 2 + small, phi_dot=6.0, psi_dot=200.0)
        yield "tilt from horizontal", small, DISC, flat, 10
        yield "regular precession, merging roots", small, TOP, merging(small), 50
        hurried = start(regular_precession_rates(TOP, THETA, 200.0)[0] * (1 + small))
        yield "regular precession, hurried by", small, TOP, hurried, 50
        for sign in (1, -1):
            light = Top(TOP.Ix, TOP.Iz, sign * small)
            nodding = State.from_euler(theta=0.5, theta_dot=1.5, phi_dot=3.0, psi_dot=200.0)
            yield f"weight {'+-'[sign < 0]}Mgl (J)", small, light, nodding, 10
    for power in range(1, 10):
        fast = State.from_euler(theta=0.5, theta_dot=3.0, psi_dot=10.0**power)
        yield "spin (rad/s)", 10.0**power, TOP, fast, 1
        yield "time (s)", 10.0**power, TOP, start(0.7), 10.0**power


def merging(small: float) -> State:
    """Return slow regular precession whose discriminant is `small` of its largest term."""
    least = 2 * math.sqrt((TOP.Ix - TOP.Iz) * TOP.Mgl * math.cos(THETA)) / TOP.Iz
    spin = least * math.sqrt(1 + small) * (1 + 2**-51)  # a root is left after rounding
    return start(regular_precession_rates(TOP, THETA, spin)[0], spin)


def entry(
    name: str, top: Top, state: State, times: list[float], friction: Friction | None = None
) -> dict[str, Any]:
    """Return the entry of a motion in the file."""
    q, omega = (part.tolist() for part in state.parts)
    inputs = Inputs.exact(*top.moments, q, omega)
    if friction:
        driven = Series(inputs, 40, (friction.axial, friction.transverse))
        exact, limits = [driven.at(t) for t in times], None
    else:
        motion = ClosedForm(inputs)
        exact = [motion.at(t) for t in times]
        limits = [error_and_limit(inputs, t, q, omega)[2] for t in times]
    return {
        "name": name,
        **dict(zip(("Ix", "Iz", "Mgl"), top.moments, strict=True)),
        "friction": [friction.axial, friction.transverse] if friction else [0.0, 0.0],
        "orientation": q,
        "angular_velocity": omega,
        "t": times,
        "exact": [digits(each[0]) for each in exact],
        "limit": limits,
    }


def driven_entry(case: DrivenCase) -> dict[str, Any]:
    """Return the entry of a motion with friction or an applied torque."""
    return {
        "name": case.family,
        **dict(zip(("Ix", "Iz", "Mgl"), case.top.moments, strict=True)),
        "friction": [case.friction.axial, case.friction.transverse],
        "torque": case.torque,
        "orientation": case.start.given_orientation.tolist(),
        "angular_velocity": case.start.angular_velocity.tolist(),
        "t": case.times,
        "exact": [digits(each[0]) for each in case.solve()],
        "limit": None,
    }


def digits(numbers: Any) -> list[str]:
    """Return numbers of mpmath as decimals."""
    return [mp.nstr(number, DIGITS) for number in numbers]


def write(path: Path) -> None:
    """Write the file."""
    hard = [
        {"small": small, **entry(family, top, state, [float(t)])}
        for family, small, top, state, t in hard_cases()
    ]
    parts = {"article": article(), "hard": hard, "driven": map(driven_entry, list_cases())}
    text = ",\n".join(
        f'"{part}": [\n' + ",\n".join(map(json.dumps, each)) + "\n]" for part, each in parts.items()
    )
    packed = lzma.compress(f"{{{text}}}\n".encode(), preset=9 | lzma.PRESET_EXTREME)
    path.write_bytes(packed)


if __name__ == "__main__":
    write(FILE)
