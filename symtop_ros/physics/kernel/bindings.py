"""The compiled kernel: the functions of symtop.h, by ctypes.

This is the one place of Python that knows the library. Every function is declared with its types:
an undeclared one would take a buffer by value, and end the process. Buffers belong to a call, so
that threads may use one motion together. The library is loaded when it is first needed.
"""

import ctypes
import sys
from collections.abc import Callable, Container, Iterable, Sequence
from ctypes import byref, c_double, c_size_t, c_uint8
from functools import cache, wraps
from struct import Struct
from types import SimpleNamespace
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError, refuse
from symtop_ros.physics.kernel.library import load_library
from symtop_ros.physics.kernel.records import (
    BAD_ANGULAR_VELOCITY,
    BAD_ARITHMETIC,
    BAD_KICK,
    ENGINES,
    FUNCTIONS,
    KINDS,
    NO_MEMORY,
    OK,
    RECORDS,
    TOO_FAR,
    VERTICAL,
    BodyRecord,
    ClockRecord,
    ConstantsRecord,
    Engine,
    ExchangeRecord,
    HeldRecord,
    Kind,
    PieceRecord,
    RatesRecord,
    SolutionsRecord,
    SpreadsRecord,
    StartRecord,
    TopRecord,
    VerdictRecord,
)
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.values import LARGEST_ANGULAR_VELOCITY

P = ParamSpec("P")
T = TypeVar("T")

STATE = 7  # numbers of an orientation and an angular velocity
BEFORE_STATE = StartRecord.orientation.offset
AFTER_STATE = StartRecord.friction.offset
START = ctypes.sizeof(StartRecord) // 8  # numbers of `symtop_start`

BLOCK = 256  # elements of a call that takes up to 0.1 ms for each

INT64 = np.dtype(np.int64).char  # "l", or "q" where a long has 32 bits (Windows)
State, Pair, Quaternion, Rates = (c_double * count for count in (STATE, 2, 4, 3))
_unpack_state = Struct(f"{STATE}d").unpack
CONSTANTS, VERDICTS = np.dtype(ConstantsRecord), np.dtype(VerdictRecord)  # of arrays
NOT_PUSHED = (VERTICAL, BAD_KICK)  # why there are no states from a push on
# These may take long, and release Python's lock.
LONG = {
    "states",
    "states_of_clock",
    "reach",
    "find_piece",
    "find_farthest_time",
    "states_of_many",
    "describe_many",
    "from_angles",
    "find_angles",
    "find_angle_rates",
    "find_regular_rates",
    "find_tilt_torques",
    "find_tilt_accelerations",
    "kick",
    "judge",
    "judge_kick",
    "judge_clamp",
    "compare_hurried",
    "find_doubt",
}


@cache
def _load() -> ctypes.CDLL:
    """Return the library, whose records are laid out as those of ctypes."""
    library = load_library()
    demand_sizes((ctypes.c_uint32 * len(RECORDS)).in_dll(library, "symtop_sizes"))
    return library


def demand_sizes(sizes: Iterable[int]) -> None:
    """Refuse a library whose records are not laid out as those of ctypes."""
    for record, size in zip(RECORDS, sizes, strict=True):
        if ctypes.sizeof(record) != size:
            raise ImportError(
                f"{record.__name__} must have the {size} bytes of the compiled kernel, got "
                f"{ctypes.sizeof(record)}: run `python -m workshop.twins` if symtop.h has changed"
            )


@cache
def bind_functions() -> SimpleNamespace:
    """Return the functions of the library, which is loaded at the first call, by their names."""
    return _bind_functions(LONG)


@cache
def bind_functions_of_one() -> SimpleNamespace:
    """Return the same functions for calls of one element, which keep the interpreter's lock.

    A thread that releases the lock may wait for it longer than such a call takes.
    """
    return _bind_functions(())


def _bind_functions(releasing: Container[str]) -> SimpleNamespace:
    """Return the functions, of which some release the interpreter's lock in their calls."""
    released = _load()
    locked = ctypes.PyDLL(released._name)
    functions = SimpleNamespace()
    for name, (result, arguments) in FUNCTIONS.items():
        # By index: a function object that belongs to this namespace alone.
        function = (released if name in releasing else locked)[f"symtop_{name}"]
        function.argtypes, function.restype = arguments, result
        setattr(functions, name, function)
    return functions


def refuse_status(status: int) -> Exception:
    """Return the exception for a status, with its sentence."""
    if status == NO_MEMORY:
        return MemoryError()
    sentence = bind_functions().describe_status(status).decode()
    return (FloatingPointError if status == BAD_ARITHMETIC else RefusedError)(sentence)


def demand(status: int) -> None:
    """Raise the exception for a status other than OK."""
    if status != OK:
        raise refuse_status(status)


def demand_arithmetic() -> None:
    """Refuse, in the kernel's words, to compute in a thread that rounds otherwise."""
    demand(bind_functions().check_arithmetic())


def compute_soundly(function: Callable[P, T]) -> Callable[P, T]:
    """Have a function of NumPy refuse as the kernel does in such a thread, and ignore underflow."""

    @wraps(function)
    def compute(*arguments: P.args, **named: P.kwargs) -> T:
        demand_arithmetic()
        with np.errstate(under="ignore"):  # although the caller's NumPy raises for it
            return function(*arguments, **named)

    return compute


def _lend(array: Any, kind: Any) -> Any:
    """Return the buffer of an array, or one of no numbers: ctypes takes no empty array.

    Records are lent as bytes: NumPy writes their whole form each time that a buffer is asked for.
    """
    numbers = array.view(np.uint8) if array.dtype.names else array
    return kind.from_buffer(numbers) if array.size else (kind * 0)()


def read_from(array: NDArray[Any], code: str = "d") -> bytes:
    """Return the numbers of an array, which may be read-only or have gaps."""
    if array.dtype.char != code:
        raise ValueError(f"array must have numbers of type {code!r}, got {array.dtype}")
    return array.tobytes()


def write_to(array: NDArray[Any], count: int, code: str = "d") -> Any:
    """Return the buffer of an array that a function writes `count` numbers to.

    ctypes refuses one that is read-only or not contiguous; it does not look at type and size.
    """
    if array.dtype.char != code or array.size != count:
        raise ValueError(
            f"array must have {count} numbers {code!r}, got {array.size}, {array.dtype}"
        )
    return _lend(array, c_double if code == "d" else c_uint8)


class KernelMotion:
    """A motion in the library, which is freed with this object."""

    __slots__ = (
        "_functions",
        "_functions_of_one",
        "_handle",
        "_is_clamped",
        "_pushes",
        "_tolerance",
        "start",
    )

    def __init__(
        self, start: bytes, pushes: bytes = b"", is_clamped: bool = False, tolerance: float = 0.0
    ) -> None:
        """Make the motion of the 15 numbers of `symtop_start`, and of those of `symtop_pushes`."""
        self._handle: int | None = None
        self.start, self._pushes, self._is_clamped = start, pushes, is_clamped
        self._tolerance = tolerance
        self._functions = bind_functions()
        # Of a motion with pushes one state may take those of all pieces before it.
        self._functions_of_one = self._functions if pushes else bind_functions_of_one()
        if len(start) != 8 * START:
            raise ValueError(f"start must have {START} numbers, got {len(start) / 8:g}")
        special = bool(pushes or is_clamped or tolerance)
        self._handle = self._make_special() if special else self._functions.make(start)
        if not self._handle:
            raise refuse_status(self._functions.new(start, byref(ctypes.c_void_p())) or NO_MEMORY)

    def _make_special(self) -> int | None:
        """Make a motion that is pushed, clamped or coarse."""
        handle = ctypes.c_void_p()
        if self._is_clamped:
            demand(self._functions.new_clamped(self.start, byref(handle)))
        elif self._tolerance:
            demand(self._functions.new_coarse(self.start, self._tolerance, byref(handle)))
        else:
            demand(self._functions.new_pushed(self.start, self._pushes, byref(handle)))
        return handle.value

    def __del__(self) -> None:
        if self._handle:
            self._functions.free(self._handle)

    def __reduce__(self) -> Any:
        """Copy and pickle a motion by its start: copies share no integration."""
        return KernelMotion, (self.start, self._pushes, self._is_clamped, self._tolerance)

    def at(self, t: float | ExactTimes) -> tuple[float, ...] | None:
        """Return quaternion and angular velocity at one time, in s or exact; None for no state."""
        if isinstance(t, ExactTimes):
            q = Quaternion()
            omega = Rates()
            clock = bytes(ClockRecord(*t.clock))
            stamp = int(t.nanoseconds).to_bytes(8, sys.byteorder, signed=True)
            given = clock, stamp, 1, 0.0
            status = self._functions_of_one.states_of_clock(
                self._handle, *given, q, omega, c_size_t()
            )
            numbers: tuple[float, ...] = (*q, *omega)
        else:
            state = State(t)
            status = self._functions.read(self._handle, state)
            numbers = _unpack_state(state)
        if status in (OK, TOO_FAR, *NOT_PUSHED):
            return numbers if status == OK else None
        raise refuse_status(status)

    def fill(
        self, times: Real | ExactTimes, orientation: Real, omega: Real, steps: float
    ) -> tuple[int, int]:
        """Write the states at times (n,); return how many were written, and the status."""
        (count,) = times.shape
        done = c_size_t()
        rest = count, steps, write_to(orientation, 4 * count), write_to(omega, 3 * count), done
        if isinstance(times, ExactTimes):
            stamps = read_from(np.asarray(times.nanoseconds), INT64)
            clock = bytes(ClockRecord(*times.clock))
            status = self._functions.states_of_clock(self._handle, clock, stamps, *rest)
        else:
            status = self._functions.states(self._handle, read_from(times), *rest)
        return done.value, status

    def find_piece(self, t: ExactTimes, steps: float) -> tuple[PieceRecord, int]:
        """Return the piece at one time between two pushes, and the status."""
        found = PieceRecord()
        clock = bytes(ClockRecord(*t.clock))
        status = self._functions.find_piece(self._handle, clock, int(t.nanoseconds), steps, found)
        return found, status

    def reach(self, t: float, steps: float) -> tuple[float, int]:
        """Integrate towards a time in s; return the time reached, and the status."""
        reached = c_double()
        status = self._functions.reach(self._handle, t, steps, reached)
        return reached.value, status

    @property
    def kind(self) -> Kind:
        """Name of the motion."""
        kind = int(self._functions.find_kind(self._handle))
        demand(OK if kind < len(KINDS) else BAD_ARITHMETIC)
        return KINDS[kind]

    @property
    def engine(self) -> Engine:
        """Method of solution."""
        return ENGINES[int(self._functions.find_engine(self._handle))]

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        angles = Pair()
        demand(self._functions.find_turning_angles(self._handle, angles))
        return angles[0], angles[1]

    @property
    def rates(self) -> RatesRecord:
        """Nutation period, mean rates, and whether the spin reverses."""
        found = RatesRecord()
        demand(self._functions.find_rates(self._handle, found))
        return found

    @property
    def farthest_time(self) -> float:
        """The time in s from which on there are no states; infinite for a driven motion."""
        farthest = c_double()
        demand(self._functions_of_one.find_farthest_time(self._handle, farthest))
        return farthest.value


def replace_state(start: bytes, orientation: Real, omega: Real) -> bytes:
    """Return the 15 numbers of `symtop_start` with another state."""
    state = read_from(orientation) + read_from(omega)
    return start[:BEFORE_STATE] + state + start[AFTER_STATE:]


def fill_many(starts: Real, times: Real, orientation: Real, omega: Real, left: Any) -> None:
    """Write the states of motions (n, 15) at times (m,) into (n, m, 4) and (n, m, 3).

    `left` (n, m) of bytes becomes 0 for a state that is written, and 1 for others.
    """
    count = len(starts)
    each = times.size
    states = write_to(orientation, 4 * count * each), write_to(omega, 3 * count * each)
    given = read_from(starts), count, read_from(times), each
    demand(bind_functions().states_of_many(*given, *states, write_to(left, count * each, "B")))


def describe_many(starts: Real) -> NDArray[Any]:
    """Return the constants of motions (n, 15), as records (n,) of `CONSTANTS`."""
    found = np.empty(len(starts), CONSTANTS)
    given = (read_from(starts), len(starts))
    demand(bind_functions().describe_many(*given, _lend(found, ConstantsRecord), c_size_t()))
    return found


def from_angles(angles: Real, rates: Real) -> tuple[Real, Real]:
    """Return orientations (..., 4) and angular velocities (..., 3) of angles and rates (..., 3)."""
    orientation = np.empty((*angles.shape[:-1], 4))
    omega = np.empty(angles.shape)
    count = omega.size // 3
    done = c_size_t()
    to = write_to(orientation, 4 * count), write_to(omega, 3 * count)
    status = bind_functions().from_angles(read_from(angles), read_from(rates), count, *to, done)
    if status == BAD_ANGULAR_VELOCITY:
        largest = float(np.abs(omega.reshape(-1, 3)[done.value]).max())
        raise refuse("angular_velocity", f"at most {LARGEST_ANGULAR_VELOCITY:g} rad/s", largest)
    demand(status)
    return orientation, omega


def _compute(name: str, width: int, *given: Real, then: tuple[int, ...] = ()) -> Real:
    """Return what a function finds for each of some elements, (..., width), of (..., columns)."""
    found = np.empty((*given[0].shape[:-1], width))
    count = found.size // width
    room = write_to(found, found.size)
    demand(getattr(bind_functions(), name)(*map(read_from, given), count, *then, room))
    return found


def find_angles(orientation: Real) -> Real:
    """Return Euler angles (..., 3) of unit quaternions (..., 4)."""
    return _compute("find_angles", 3, orientation)


def find_angle_rates(orientation: Real, omega: Real) -> Real:
    """Return rates of the Euler angles (..., 3) of states (..., 4) and (..., 3)."""
    return _compute("find_angle_rates", 3, orientation, omega)


def find_tilt_torques(tops: Real, thetas: Real, phi_dots: Real, psi_dots: Real) -> Real:
    """Return the parts of Ix theta''/sin(theta) and sin(theta), (n, 4), of tops (n, 3)."""
    return _compute("find_tilt_torques", 4, tops, thetas, phi_dots, psi_dots)


def find_regular_rates(tops: Real, thetas: Real, spins: Real, hold: int) -> Real:
    """Return slow and fast rates (n, 2) of tops (n, 3), nan for a rate that there is not."""
    columns = tops, thetas, spins
    return np.concatenate(
        [
            _compute("find_regular_rates", 2, *(each[part] for each in columns), then=(hold,))
            for part in _list_blocks(len(tops)) or [slice(0)]
        ]
    )


def find_body(kinds: Sequence[int], parts: Sequence[Sequence[float]]) -> BodyRecord:
    """Return mass, arm and moments about the centre of parts: mass, size, distance of each."""
    found = BodyRecord()
    given = np.array(kinds, np.int32).tobytes(), np.array(parts, np.float64).tobytes()
    demand(bind_functions().find_body(*given, len(kinds), found, c_size_t()))
    return found


def find_body_top(body: Sequence[float], gravity: float) -> TopRecord:
    """Return Ix, Iz and Mgl of a body: mass, arm and moments about its centre."""
    found = TopRecord()
    demand(bind_functions().find_body_top(bytes(BodyRecord(*body)), gravity, found))
    return found


def solve_start(top: Sequence[float], seen: int, known: Sequence[float]) -> SolutionsRecord:
    """Return the starts that have what is known of them, or why no start has it."""
    found = SolutionsRecord()
    numbers = (*known, 0.0)[:3]
    given = bytes(TopRecord(*top)), seen, bytes(Rates(*numbers))
    demand(bind_functions().solve_start(*given, found))
    return found


def find_spreads(
    top: Sequence[float], seen: int, known: Sequence[float], half_widths: Sequence[float]
) -> SpreadsRecord:
    """Return how far starts move with what is known of them."""
    found = SpreadsRecord()
    pair = [bytes(Rates(*(*each, 0.0)[:3])) for each in (known, half_widths)]
    demand(bind_functions().find_spreads(bytes(TopRecord(*top)), seen, *pair, found))
    return found


def kick(
    tops: Real, orientation: Real, omega: Real, kind: int, hold: int, amounts: Real
) -> tuple[Real, int, int]:
    """Return angular velocities (n, 3) after kicks, how many are done, and the status."""
    kicked = np.empty(omega.shape)
    done = c_size_t()
    count = omega.size // 3
    state = map(read_from, (tops, orientation, omega))
    to = write_to(kicked, 3 * count)
    functions = bind_functions_of_one() if count == 1 else bind_functions()
    status = functions.kick(*state, kind, hold, read_from(amounts), count, to, done)
    return kicked, done.value, status


def judge(starts: Real, factors: Real, hold: int) -> tuple[NDArray[Any], int]:
    """Return the verdicts on starts (n, 15), as records (n,) of `VERDICTS`, and the status.

    If the status is not OK, the verdicts end before the start that it is about.
    """
    verdicts = np.empty(len(starts), VERDICTS)
    done = c_size_t()
    for part in _list_blocks(len(starts)):
        room = _lend(verdicts[part], VerdictRecord)
        given = read_from(starts[part]), read_from(factors[part]), part.stop - part.start
        status = bind_functions().judge(*given, hold, room, done)
        if status != OK:
            return verdicts[: part.start + done.value], status
    return verdicts, OK


def judge_kick(before: bytes, after: bytes, hold: int) -> VerdictRecord:
    """Return the verdict on the kick that leads from one start to another."""
    verdict = VerdictRecord()
    demand(bind_functions().judge_kick(before, after, hold, verdict))
    return verdict


def judge_clamp(start: bytes) -> HeldRecord:
    """Return what follows if the precession of a start is held."""
    held = HeldRecord()
    demand(bind_functions().judge_clamp(start, held))
    return held


def find_doubt(start: bytes) -> float:
    """Return the time in s from which rounding shows in a motion; infinite for never."""
    shows_at = c_double()
    demand(bind_functions().find_doubt(start, shows_at))
    return shows_at.value


def find_exchange(top: Sequence[float], orientations: Real, omegas: Real) -> ExchangeRecord:
    """Return what a top gains between two states, (2, 4) and (2, 3)."""
    found = ExchangeRecord()
    states = read_from(orientations), read_from(omegas)
    demand(bind_functions().find_exchange(bytes(TopRecord(*top)), *states, found))
    return found


def compare_hurried(
    tops: Real, thetas: Real, phi_dots: Real, psi_dots: Real, factor: float, hold: int
) -> tuple[Real, NDArray[np.uint8]]:
    """Return the other turning angles without a kick and with it, (n, 2), and the rule, (n,)."""
    angles = np.empty((len(tops), 2))
    rules = np.empty(len(tops), np.uint8)
    for part in _list_blocks(len(tops)):
        given = [read_from(each[part]) for each in (tops, thetas, phi_dots, psi_dots)]
        count = part.stop - part.start
        to = write_to(angles[part], 2 * count), write_to(rules[part], count, "B")
        demand(bind_functions().compare_hurried(*given, count, factor, hold, *to))
    return angles, rules


def kernel_version() -> str:
    """Return the version of the compiled kernel."""
    return str(bind_functions().version().decode())


def _list_blocks(count: int) -> list[slice]:
    """Return the parts of arrays that take some ms: Python sees signals between two calls."""
    return [slice(first, min(first + BLOCK, count)) for first in range(0, count, BLOCK)]
