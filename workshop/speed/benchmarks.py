"""The benchmarks of the report and their results, as plain data."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf
from timeit import repeat

import numpy as np

from symtop_ros.physics import Motion
from workshop.speed.footprint import Footprint, measure_footprint
from workshop.speed.many import ManyCost, Program, find_programs, measure_many
from workshop.speed.peers import CLOSED_FORM, SERIES_TOLERANCES, TAYLOR, prepare
from workshop.speed.peers.peer import Peer, PrepareArrays, Solution, spread_times
from workshop.speed.reference import EPS, Reference, ReferenceMotion
from workshop.speed.sweep import REPEATS, Curve, sweep_motion, time_call

SPAN = 10.0  # s
CHECK = 2.0**-5  # s on which a peer's model must be right at its finest setting
RIGHT = 1e-4  # rad; a weight that is one percent off makes 6e-4
LARGEST_ERROR = 20 * EPS  # rad, as docs/accuracy.md promises of an attitude
LARGEST_TAYLOR_ERROR = 4 * EPS  # rad, in ten seconds of the article's top
LARGEST_DRIVEN_ERROR = 2e-13  # rad, in the families of motions with friction or a torque
LARGEST_PHASE = 1e5  # rad of turning that a peer is asked for in a hard case
DRIVEN_RUNS = 7  # of which the shortest counts
# of motions with friction or a torque
DRIVEN_PEER = "heyoka, turning frame"
DRIVEN_FORMS = (DRIVEN_PEER, "heyoka, turning frame, known spin")
DRIVEN_LEVEL = 1e-9  # rad
DRIVEN_BEST = f"heyoka, best form for {DRIVEN_LEVEL:.0e}"
DRIVEN_OWN = f"{TAYLOR} for {DRIVEN_LEVEL:.0e}"
DRIVEN_TOLERANCES = (1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, EPS)
# The peers of the quick report, which must not take long, by the beginnings of their names
EVERY_MOTION = (CLOSED_FORM, TAYLOR, "SciPy, elliptic functions", "heyoka", "CyRK")
FIRST_MOTION = (
    "SciPy DOP853",
    "SciPy LSODA",
    "MuJoCo RK4",
    "Drake RK5, quaternion",
    "EXUDYN RK67",
    "diffrax Dopri8",
)
HARD_PEERS = ("SciPy DOP853, quaternion", "heyoka, quaternion", "heyoka, turning frame, 80 bits")


@dataclass(frozen=True)
class Scope:
    """The amount of work of a report."""

    # True if every peer integrates every motion, and not only the best form of each program
    is_full: bool
    motions: int  # number of the nine motions without friction, counted from the first
    limit: float  # seconds that one run of a peer may take
    growth_limit: float  # the same for the growth of the error with time
    states: tuple[int, ...]  # numbers of states in an array
    hard_peers: tuple[str, ...]  # peers that try the hard cases
    driven: int = 1  # 1 to try all motions with friction and torques, n to try each n-th
    many: int = 10_000  # number of different motions, for each program

    def includes(self, peer: Peer, number: int) -> bool:
        """Return True if a peer integrates the article's motion of this number."""
        best = EVERY_MOTION if number else EVERY_MOTION + FIRST_MOTION
        return self.is_full or peer.name.startswith(best)


QUICK = Scope(False, 9, 4.0, 1.0, tuple(10**k for k in range(8)), HARD_PEERS[1:])
FULL = Scope(True, 9, 60.0, 60.0, tuple(10**k for k in range(8)), HARD_PEERS)
SMALL = Scope(False, 1, 0.02, 0.02, (1, 10), (), 9, 2)  # for tests


@dataclass(frozen=True)
class Growth:
    """Errors at the end (rad) and seconds of a peer, for motions of growing length (s)."""

    peer: str
    setting: float
    times: tuple[float, ...]
    errors: tuple[float, ...]
    seconds: tuple[float, ...]


@dataclass(frozen=True)
class ArrayCost:
    """Seconds for arrays of states over ten seconds, set-up included, by number of states."""

    peer: str
    numbers: tuple[int, ...]
    seconds: tuple[float, ...]
    error: float  # largest in rad, over `RECORDED` states


@dataclass(frozen=True)
class HardCase:
    """Errors in rad in a hard case: the package's, and those of peers."""

    family: str
    small: float
    limit: float
    error: float
    peers: dict[str, float]


@dataclass(frozen=True)
class DrivenCase:
    """Errors in rad and times in s of a motion with friction or an applied torque, by peer."""

    family: str
    errors: dict[str, float]
    seconds: dict[str, float]


@dataclass
class Results:
    """All results, in the order in which they were measured."""

    # largest error in rad of each peer's model at its finest setting, within `CHECK` s
    checks: dict[str, float] = field(default_factory=dict)
    curves: list[Curve] = field(default_factory=list)
    growth: list[Growth] = field(default_factory=list)
    states: list[ArrayCost] = field(default_factory=list)
    hard: list[HardCase] = field(default_factory=list)
    driven: list[DrivenCase] = field(default_factory=list)
    many: list[ManyCost] = field(default_factory=list)
    footprint: Footprint | None = None

    def find_curve(self, peer: str, motion: str) -> Curve:
        """Return the curve of a peer for a motion."""
        return next(c for c in self.curves if (c.peer, c.motion) == (peer, motion))

    def list_failures(self) -> list[str]:
        """Return the errors of the package above the limit, and peers whose model is different."""
        wrong = [name for name, error in self.checks.items() if error > RIGHT]
        missed = [case for case in self.hard if case.error > LARGEST_ERROR]
        return [
            *(f"{name}: the model is a different top" for name in wrong),
            *(f"{case.family}, {case.small:g}: error {case.error:.1e}" for case in missed),
            *self._list_closed_form_failures(),
            *self._list_taylor_failures(),
        ]

    def _list_closed_form_failures(self) -> Iterator[str]:
        first = Reference.read().article[0]
        points = [(c.motion, c.t, c.best.error) for c in self.curves if c.peer == CLOSED_FORM]
        for each in self.growth:
            if each.peer == CLOSED_FORM:
                points += [(first.name, t, e) for t, e in zip(each.times, each.errors, strict=True)]
                # A time that was not reached is a failure too.
                points += [(first.name, t, inf) for t in first.times if t > max(each.times)]
        for name, t, error in points:
            if error > LARGEST_ERROR:
                yield f"{name} at {t:g} s: error {error:.1e}"

    def _list_taylor_failures(self) -> Iterator[str]:
        for curve in self.curves:
            if curve.peer == TAYLOR and curve.best.error > LARGEST_TAYLOR_ERROR:
                yield f"{TAYLOR}: error {curve.best.error:.1e}"
        for case in self.driven:
            if case.errors[TAYLOR] > LARGEST_DRIVEN_ERROR:
                yield f"{case.family}: error {case.errors[TAYLOR]:.1e}"


Step = tuple[str, Callable[[], None]]  # text for a progress bar, and the work


def list_steps(scope: Scope, peers: Sequence[Peer], results: Results) -> Iterator[Step]:
    """Yield the steps of a report in their order; running a step adds to the results."""
    reference = Reference.read()
    first = reference.article[0]
    with_friction = reference.article[-1]
    chosen = [peer for peer in peers if scope.includes(peer, 0)]
    frictionless = [peer for peer in chosen if peer.friction != "only"]
    yield "footprint", partial(_measure_footprint, scope, results)
    for peer in frictionless:
        yield f"{peer.name}: model", partial(_check, peer, first, results)
    for number, motion in enumerate(reference.article[: scope.motions]):
        for peer in frictionless:
            if scope.includes(peer, number):
                yield f"{peer.name}: {motion.name}", partial(_sweep, peer, motion, scope, results)
    for peer in chosen:
        if peer.friction != "no" and scope.includes(peer, 1):
            work = partial(_sweep, peer, with_friction, scope, results)
            yield f"{peer.name}: {with_friction.name}", work
    every = [peer for peer in frictionless if scope.includes(peer, 1)]
    for peer in every:
        yield f"{peer.name}: long times", partial(_lengthen, peer, first, scope, results)
    for peer in every:
        if peer.prepare_arrays:
            work = partial(_time_arrays, peer.name, peer.prepare_arrays, first, scope, results)
            yield f"{peer.name}: arrays", work
    for name, program in find_programs():
        work = partial(_time_many, name, program, scope, results)
        yield f"{name}: many motions", work
    tried = [peer for peer in peers if peer.name in scope.hard_peers]
    for motion in reference.hard:
        yield motion.name, partial(_try, motion, tried, results)
    compared = [peer for peer in peers if peer.name in (TAYLOR, *DRIVEN_FORMS)]
    for motion in reference.driven[:: scope.driven]:
        yield motion.name, partial(_drive, motion, compared, results)


def _measure_footprint(scope: Scope, results: Results) -> None:
    results.footprint = measure_footprint(scope.states[-1])


def _check(peer: Peer, motion: ReferenceMotion, results: Results) -> None:
    record = peer.prepare(motion.task, peer.settings[-1]).record(CHECK)
    results.checks[peer.name] = float(motion.errors(*record).max())


def _sweep(peer: Peer, motion: ReferenceMotion, scope: Scope, results: Results) -> None:
    results.curves.append(sweep_motion(peer, motion, SPAN, scope.limit))


def _lengthen(peer: Peer, motion: ReferenceMotion, scope: Scope, results: Results) -> None:
    """Measure motions ten times as long each time, within the limit of time."""
    best = results.find_curve(peer.name, motion.name).best
    solution = peer.prepare(motion.task, best.setting)
    times, errors, seconds = [], [], []
    for t in (t for t in motion.times if t >= SPAN):
        # Each peer fails in its own way if a motion is too long for it, so that no narrower
        # exception is possible. The shorter motions are reported.
        try:
            errors.append(motion.error(t, solution.reach(t)))
        except Exception:
            break
        times.append(t)
        seconds.append(time_call(partial(solution.reach, t)))
        # The time of the closed form does not grow. Another program may take the processor in the
        # middle of a measurement, and must not cut its curve short.
        if peer.name != CLOSED_FORM and 10 * seconds[-1] > scope.growth_limit:
            break
    columns = (tuple(each) for each in (times, errors, seconds))
    results.growth.append(Growth(peer.name, best.setting, *columns))


def _time_arrays(
    name: str, prepare: PrepareArrays, motion: ReferenceMotion, scope: Scope, results: Results
) -> None:
    arrays = prepare(motion.task)
    seconds = []
    times = spread_times(SPAN)
    error = float(motion.errors(times, arrays(times)).max())
    for number in scope.states:
        times = np.linspace(0.0, SPAN, number + 1)[1:]
        seconds.append(time_call(partial(arrays, times), scope.limit / REPEATS))
    results.states.append(ArrayCost(name, scope.states, tuple(seconds), error))


def _time_many(name: str, program: Program, scope: Scope, results: Results) -> None:
    results.many.append(measure_many(name, program, scope.many, SPAN))


def _try(motion: ReferenceMotion, peers: Sequence[Peer], results: Results) -> None:
    (t,) = motion.times
    error = motion.error(t, prepare(motion.task, 0.0).reach(t))
    limit = motion.limit(t)
    if np.linalg.norm(motion.task.start.angular_velocity) * t >= LARGEST_PHASE:
        peers = ()
    solutions = {peer.name: _prepare_default(peer, motion.task) for peer in peers}
    errors = {name: motion.error(t, each.reach(t)) for name, each in solutions.items()}
    results.hard.append(HardCase(motion.name, motion.small or 0.0, limit, error, errors))


def _drive(motion: ReferenceMotion, peers: Sequence[Peer], results: Results) -> None:
    """Measure a motion with friction or a torque: at defaults, and each in its best form."""
    found = {}
    for peer in (each for each in peers if each.name in (TAYLOR, DRIVEN_PEER)):
        found[peer.name] = _measure_driven(motion, _prepare_default(peer, motion.task))
        if peer.name == TAYLOR:
            found[DRIVEN_OWN] = _measure_driven_setting(motion, peer, SERIES_TOLERANCES)
    forms = [peer for peer in peers if peer.name in DRIVEN_FORMS]
    if any(motion.task.applied_torque):
        forms = [peer for peer in forms if peer.name == DRIVEN_PEER]  # the others have no torque
    if forms:
        good = [_measure_driven_setting(motion, peer, DRIVEN_TOLERANCES) for peer in forms]
        found[DRIVEN_BEST] = min(good, key=lambda each: each[1])
    errors, seconds = ({name: each[k] for name, each in found.items()} for k in range(2))
    results.driven.append(DrivenCase(motion.name, errors, seconds))


def _measure_driven_setting(
    motion: ReferenceMotion, peer: Peer, tolerances: Sequence[float]
) -> tuple[float, float]:
    """Return error and time at the coarsest tolerance good to `DRIVEN_LEVEL`, or at the finest."""
    for tolerance in tolerances:
        solution = peer.prepare(motion.task, tolerance)
        if _find_driven_error(motion, solution) <= DRIVEN_LEVEL:
            break
    return _measure_driven(motion, solution)


def _measure_driven(motion: ReferenceMotion, solution: Solution) -> tuple[float, float]:
    """Return the error in rad and the shortest time in s of some runs."""
    reach = partial(solution.reach, motion.times[-1])
    return _find_driven_error(motion, solution), min(repeat(reach, number=1, repeat=DRIVEN_RUNS))


def _find_driven_error(motion: ReferenceMotion, solution: Solution) -> float:
    return max(motion.error(t, solution.reach(t)) for t in motion.times)


def _prepare_default(peer: Peer, task: Motion) -> Solution:
    """Return the solution at the finest setting of a peer, or at the default of heyoka."""
    has_default = "heyoka" in peer.name and "80 bits" not in peer.name
    return peer.prepare(task, EPS if has_default else peer.settings[-1])
