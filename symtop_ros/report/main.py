"""Entry point of `top_report`: what a motion costs and how far it is off, beside a peer.

The peer is SciPy's DOP853 on the quaternion and Euler's equations, at its tightest tolerance. How
far it is off is its distance from the closed form, which the tests hold to 30-digit references.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from symtop_ros.physics import Friction, Motion, State, Top, motion, splitting
from symtop_ros.report.peer import derivative

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
FRICTION = Friction(axial=2e-6, transverse=1e-5)
Real = NDArray[np.float64]
SCENES = {
    "cusps": State.from_euler(theta=0.5, psi_dot=200.0),
    "wave at 9 rad/s": State.from_euler(theta=0.5, psi_dot=200.0, phi_dot=9.0),
    "near the separatrix": State.from_euler(theta=1e-3, psi_dot=100.0),
}
REPEATS = 7
MOST_POINTS = 4000
MOST_STATES = 10_000_000
LONGEST = 3600.0  # s for each figure of the node
SPANS = (1.0, 10.0, 100.0)  # s


def main(args: list[str] | None = None) -> int:
    """Print the table; return the exit status."""
    parser = argparse.ArgumentParser(prog="top_report", description=__doc__.splitlines()[0])
    parser.add_argument("--states", type=int, default=10_000, help="states in an array")
    parser.add_argument("--node", action="store_true", help="the node instead, beside a bare one")
    parser.add_argument("--seconds", type=float, default=10.0, help="for each figure of --node")
    parser.add_argument("--map", type=Path, metavar="FOLDER", help="Perry's maps instead")
    parser.add_argument("--points", type=int, default=1000, help="along each side of --map")
    options = parser.parse_args(args)
    if options.states < 1 or options.states > MOST_STATES:
        allowed = f"allowed is 1 or more, up to {MOST_STATES}"
        print(f"top_report: --states: got {options.states}, {allowed}", file=sys.stderr)
        return 2
    if options.map:
        return _perrys_maps(options.map, options.points)
    if options.node:
        return _load_of_the_node(options.seconds)
    print(f"{'':24}{'set-up':>12}{'first state':>13}{'at(t)':>10}{'in an array':>14}   (us)")
    for name, start in SCENES.items():
        print(f"{name:24}" + _cost_of_closed_form(start, options.states), flush=True)
    print(f"\nThe article's top on cusps, one state after t seconds:\n{'t (s)':>10}", end="")
    print(f"{'closed form':>16}{'DOP853':>14}{'ratio':>10}{'DOP853 is off by':>20}")
    for t in SPANS:
        print(_beside_the_peer(SCENES["cusps"], t), flush=True)
    print(
        f"\nThe same with friction, integrated:\n{'t (s)':>10}{'splitting':>16}{'off by':>10}",
        end="",
    )
    print(f"{'DOP853':>14}{'ratio':>10}{'DOP853 is off by':>20}")
    for t in SPANS[:2]:
        print(_friction_beside_the_peer(SCENES["cusps"], t), flush=True)
    return 0


def _perrys_maps(folder: Path, points: int) -> int:
    """Only this needs matplotlib and Rerun."""
    if not 2 <= points <= MOST_POINTS:
        allowed = f"allowed is 2 ... {MOST_POINTS}"
        print(f"top_report: --points: got {points}, {allowed}", file=sys.stderr)
        return 2
    try:
        from symtop_ros.report.perry.main import chart
    except ImportError as error:
        print(f"top_report: --map needs the extra `report`: {error}", file=sys.stderr)
        return 1
    return chart(folder, points)


def _load_of_the_node(seconds: float) -> int:
    """Only this needs ROS."""
    if not 0 < seconds <= LONGEST:
        allowed = f"allowed is more than 0, up to {LONGEST:g}"
        print(f"top_report: --seconds: got {seconds}, {allowed}", file=sys.stderr)
        return 2
    try:
        from symtop_ros.report.load import table
    except ImportError as error:
        print(f"top_report: --node needs ROS 2: {error}", file=sys.stderr)
        return 1
    for part in table(seconds):
        print(part, end="", flush=True)
    return 0


def _cost_of_closed_form(start: State, states: int) -> str:
    path = motion(ARTICLE, start)
    columns = [
        _microseconds(lambda: motion(ARTICLE, start)),
        _microseconds(lambda: motion(ARTICLE, start).at(1.0)),
    ]
    for span in (1.0, 1e6):
        times = np.linspace(0.0, span, states)
        columns.append(_microseconds(lambda span=span: path.at(span)))  # type: ignore[misc]
        columns.append(_microseconds(lambda t=times: path.at(t)) / states)  # type: ignore[misc]
    setup, first, at, array, late_at, late_array = columns
    return (
        f"{setup:12.1f}{first:13.1f}{at:10.1f}{array:14.3f}"
        f"   and at t = 1e6 s {late_at:.1f}, {late_array:.3f}"
    )


def _beside_the_peer(start: State, t: float) -> str:
    path = motion(ARTICLE, start)
    ours = _microseconds(lambda: motion(ARTICLE, start).at(t))
    began = time.perf_counter()
    off = _error_of_peer(path, t)
    peer = (time.perf_counter() - began) * 1e6
    return f"{t:10g}{ours:13.1f} us{peer / 1e3:11.1f} ms{peer / ours:9.0f}x{off:20.1e}"


def _friction_beside_the_peer(start: State, t: float) -> str:
    """Errors are distances from the splitting with steps of a quarter, 65 000 times as exact."""
    ours = _microseconds(lambda: motion(ARTICLE, start, FRICTION).at(t))
    steps = splitting.STEP
    try:
        splitting.STEP = steps / 4
        exact = motion(ARTICLE, start, FRICTION).at(t).orientation
    finally:
        splitting.STEP = steps
    path = motion(ARTICLE, start, FRICTION)
    off = _distance(path.at(t).orientation, exact)
    began = time.perf_counter()
    q = _peer(path, t)
    peer = (time.perf_counter() - began) * 1e6
    line = f"{t:10g}{ours / 1e3:13.1f} ms{off:10.1e}{peer / 1e3:11.1f} ms{peer / ours:9.0f}x"
    return line + f"{_distance(q, exact):20.1e}"


def _error_of_peer(path: Motion, t: float) -> float:
    return _distance(_peer(path, t), path.at(t).orientation)


def _peer(path: Motion, t: float) -> Real:
    """Quaternion at t by DOP853."""
    top, friction = path.top, path.friction
    arguments = (*top.moments, friction.axial, friction.transverse)
    solution = solve_ivp(
        derivative,
        (0.0, t),
        np.concatenate(list(path.start)),
        method="DOP853",
        rtol=1e-13,
        atol=1e-13,
        args=arguments,
    )
    q: Real = solution.y[:4, -1]
    return q / np.linalg.norm(q)


def _distance(p: Real, q: Real) -> float:
    return float(min(np.linalg.norm(p - q), np.linalg.norm(p + q)))


def _microseconds(call: Callable[[], object]) -> float:
    """Best of some repeats, each of at least 10 ms."""
    began = time.perf_counter()
    call()
    number = max(1, int(0.01 / max(time.perf_counter() - began, 1e-6)))
    best = float("inf")
    for _ in range(REPEATS):
        began = time.perf_counter()
        for _ in range(number):
            call()
        best = min(best, (time.perf_counter() - began) / number)
    return best * 1e6
