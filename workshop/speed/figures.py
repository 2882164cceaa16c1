"""Figures of docs/accuracy.md and docs/many.md that no table has: `make -C workshop figures`.

Each line has the text that the documents have, with its number as measured now.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from statistics import median
from timeit import repeat
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Friction, Motion, Motions, State, Top
from symtop_ros.physics.gpu.draw import draw_family
from symtop_ros.truth.testset.score import measure_angles
from workshop.speed.peers import prepare
from workshop.speed.peers.peer import body_rates, normalize
from workshop.speed.peers.turning_frame import frame_rates, turn_about_axis
from workshop.speed.reference import EPS, Reference, ReferenceMotion

ARTICLE = Top(0.000228, 0.0000572, 0.068)
ROD = Top(0.000228, 0.0000114, 0.068)
START = State.from_euler(theta=0.5, psi_dot=200.0)
FRICTION = Friction(1e-300, 1e-300)  # changes no digit, and makes a motion one that is integrated
OTHER_DATA = 48_000_000  # bytes, more than the caches have
RUNS = 30
STATES = 1_000_000
MANY = 10_000
SEED, TOPS, SPAN = 20261126, 300, 10.0  # of tops that Runge and Kutta integrate, in s
TOLERANCES = 1e-15, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6
STEPS = 1000, 3000, 10_000, 30_000
FIRST = """
import time
from symtop_ros.physics import Motion, State, Top
given = Top(0.000228, 0.0000572, 0.068), State.from_euler(theta=0.5, psi_dot=200.0)
began = time.perf_counter()
Motion(*given).at(10.0)
print(time.perf_counter() - began)
"""


def print_figures(folder: object = None) -> None:
    """Print all figures; nothing is written."""
    del folder
    for lines in (list_calls, list_long_times, list_tolerances, list_threads, list_runge_kutta):
        for line in lines():
            print(line, flush=True)


def list_calls() -> Iterator[str]:
    """Yield the times of a motion and its state in Python."""
    warm = min(repeat(find_state, number=1, repeat=100 * RUNS))
    yield f"with the call from Python: {1e3 * warm:.2g} ms"
    yield f"after 48 MB of other data: {1e3 * median(_time_cold() for _ in range(RUNS)):.2g} ms"
    yield f"in a process that has just started: {1e3 * _time_new_process():.2g} ms"
    each = min(repeat(partial(_judge, MANY), number=1, repeat=3)) / MANY
    yield f"kind, turning angles and mean rates of a motion: {1e6 * each:.2g} us"


def find_state() -> object:
    """Return a state of a new motion."""
    return Motion(ARTICLE, START).at(10.0)


def _time_cold() -> float:
    np.arange(OTHER_DATA // 8, dtype=float).sum()
    began = time.perf_counter()
    find_state()
    return time.perf_counter() - began


def _time_new_process() -> float:
    command = [sys.executable, "-c", FIRST]
    return median(float(subprocess.check_output(command, text=True)) for _ in range(5))


def _judge(count: int) -> object:
    motions = Motions(ARTICLE, State.from_euler(theta=np.linspace(0.3, 0.9, count), psi_dot=200.0))
    return motions.kind, motions.turning_angles, motions.mean_precession_rate


def list_long_times() -> Iterator[str]:
    """Yield the errors of integrated motions after long times, against the closed form."""
    for name, top in (("of the article's top", ARTICLE), ("of a rod with Iz = Ix/20", ROD)):
        for t in (100.0, 1000.0):
            exact = Motion(top, START).at(t).orientation
            found = Motion(top, START, FRICTION).at(t).orientation
            error = float(measure_angles(found, exact, np.zeros(4)))
            yield f"under friction of 1e-300 after {t:g} s {name}: {error / EPS:.1g} eps"


def list_tolerances() -> Iterator[str]:
    """Yield errors and times of the report's driven motions with a tolerance."""
    motions = Reference.read().driven
    exact = [_measure_driven(motion, 0.0) for motion in motions]
    for tolerance in TOLERANCES:
        found = [_measure_driven(motion, tolerance) for motion in motions]
        ratio = median(part[1] / whole[1] for part, whole in zip(found, exact, strict=True))
        errors = [error for error, _ in found]
        middle, largest = median(errors), max(errors)
        yield f"| {tolerance:.0e} | {ratio:.2f} | {middle:.0e} rad | {largest:.0e} rad |"


def _measure_driven(motion: ReferenceMotion, tolerance: float) -> tuple[float, float]:
    """Return the largest error in rad and the shortest time in s of some runs."""
    reach = prepare(motion.task, tolerance).reach
    error = max(motion.error(t, reach(t)) for t in motion.times)
    return error, min(repeat(partial(reach, motion.times[-1]), number=1, repeat=7))


def list_threads() -> Iterator[str]:
    """Yield what one thread and two compute in a second."""
    times = np.linspace(0.0, 10.0, STATES)
    motion = Motion(ARTICLE, START)
    spins = np.linspace(150.0, 250.0, MANY)
    works: list[tuple[str, float, Callable[[int, int], object]]] = [
        ("million states of a motion", 1e6, lambda k, n: motion.at(np.array_split(times, n)[k])),
        (
            "thousand motions with 20 states each",
            1e3,
            lambda k, n: Motions(
                ARTICLE, State.from_euler(theta=0.5, psi_dot=np.array_split(spins, n)[k])
            ).at(times[:20]),
        ),
    ]
    for (name, unit, work), count in zip(works, (STATES, MANY), strict=True):
        for threads in (1, 2):
            with ThreadPoolExecutor(threads) as pool:
                seconds = min(repeat(partial(_share, pool, work, threads), number=1, repeat=5))
            yield f"{threads} threads, {name} a second: {count / seconds / unit:.2g}"


def _share(
    pool: ThreadPoolExecutor, work: Callable[[int, int], object], threads: int
) -> list[object]:
    return list(pool.map(work, range(threads), [threads] * threads))


def list_runge_kutta() -> Iterator[str]:
    """Yield errors of the classical method of fourth order after 10 s, by the number of steps."""
    starts, _ = draw_family("generic", TOPS, np.random.default_rng(SEED))
    start = State(starts[:, 3:7], starts[:, 7:10])
    motions: Any = Motions(Top(*starts[:, :3].T), start)
    exact = motions.at(SPAN).orientation
    first = [*normalize(starts[:, 3:7]).T, *starts[:, 7:10].T]
    half = (1 - motions.top.Iz / motions.top.Ix) / 2
    for steps in STEPS:
        body = np.array(integrate(partial(body_rates, motions), first, steps)[:4]).T
        framed = integrate(
            partial(frame_rates, motions, number=np.asarray), [*first, np.zeros(TOPS)], steps
        )
        turned = turn_about_axis(normalize(np.array(framed[:4]).T), half * framed[7])
        errors = (
            np.median(measure_angles(found, exact, np.zeros_like(exact)))
            for found in (normalize(body), turned)
        )
        of_body, of_frame = (f"{each:.1g} rad" for each in errors)
        yield f"Runge-Kutta, {steps} steps: median {of_body}; in the turning frame {of_frame}"


def integrate(rates: Callable[..., list[Any]], start: list[Real], steps: int) -> list[Real]:
    """Return variables after `SPAN` s, by steps of the classical method of fourth order."""
    h = SPAN / steps
    now = tuple(start)
    for _ in range(steps):
        one = rates(0.0, now)
        two = rates(0.0, _move(now, one, h / 2))
        three = rates(0.0, _move(now, two, h / 2))
        four = rates(0.0, _move(now, three, h))
        slopes = zip(one, two, three, four, strict=True)
        now = _move(now, [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in slopes], h)
    return [np.broadcast_to(each, start[0].shape) for each in now]


def _move(now: tuple[Real, ...], slopes: list[Any], h: float) -> tuple[Real, ...]:
    return tuple(each + h * slope for each, slope in zip(now, slopes, strict=True))
