"""The device: CuPy, the functions compiled for it, and their trial against the CPU."""

import hashlib
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.physics.kernel import bindings, library

# Orientations, angular velocities, and 0 for each state that is there.
States = tuple[Any, Any, Any]
SOURCES = Path(__file__).parent / "device"
MAIN = SOURCES / "motions.cu"
SHIM = SOURCES / "shim"
# Products are rounded before they are added, and what the headers define without a word of CUDA is
# for the device. 177: functions of the kernel that are not used here.
OPTIONS = ("-default-device", "-device-int128", "--fmad=false", "--std=c++17", "-diag-suppress=177")
FUNCTIONS = (
    "prepare_motions",
    "prepare_free_motions",
    "read_states",
    "read_free_states",
    "read_statuses",
    "find_size_of_motion",
)
BLOCK = 64  # threads
PERIOD = 10.0  # s between two lines while the functions are compiled
TRIAL = Path(__file__).with_name("trial.npy")  # rows of a start (15 numbers) and a time
NO_CUPY = "symtop_ros.physics.gpu needs CuPy: pip install 'symtop_ros[gpu-cuda13]' (or gpu-cuda12)"


class DeviceError(RuntimeError):
    """The GPU cannot be used; the text says why."""


@cache
def open_cupy() -> Any:
    """Return the module `cupy`, if it finds a GPU."""
    try:
        import cupy
    except ImportError:
        raise ImportError(NO_CUPY) from None
    try:
        cupy.cuda.runtime.getDeviceCount()
    except Exception as error:
        raise DeviceError(f"a GPU of NVIDIA must be there, got none ({error})") from None
    return cupy


class Functions:
    """The functions of motions.cu on the current device, which have passed their trial.

    Attributes
    ----------
    motion_bytes : int
        Memory of a motion.
    """

    def __init__(self, module: Any) -> None:
        self._cupy = open_cupy()
        self._functions = {name: module.get_function(name) for name in FUNCTIONS}
        size = self._cupy.zeros(1, np.int64)
        self._functions["find_size_of_motion"]((1,), (1,), (size,))
        self.motion_bytes = int(size[0])

    def prepare(self, starts: Any) -> tuple[Any, Any]:
        """Set up motions from starts (n, 15); return them (n, bytes), and their statuses (n,)."""
        count = len(starts)
        motions = self._cupy.empty((count, self.motion_bytes), np.uint8)
        status = self._cupy.empty(count, np.int32)
        for name in ("prepare_motions", "prepare_free_motions"):
            self._launch(name, count, starts, np.int64(count), motions)
        self._launch("read_statuses", count, motions, np.int64(count), status)
        return motions, status

    def read(self, motions: Any, times: Any, each: int, stride: int) -> States:
        """Return orientations, angular velocities and statuses of `each` states of each motion."""
        count = len(motions)
        empty = self._cupy.empty
        to = empty((count, each, 4)), empty((count, each, 3)), empty((count, each), np.uint8)
        sizes = np.int64(each), np.int64(stride)
        for name in ("read_states", "read_free_states"):
            self._launch(name, count * each, motions, np.int64(count), times, *sizes, *to)
        return to

    def _launch(self, name: str, threads: int, *arguments: Any) -> None:
        if threads:
            self._functions[name](((threads + BLOCK - 1) // BLOCK,), (BLOCK,), arguments)


def open_functions() -> Functions:
    """Return the functions of the current device; they are compiled and tried at the first call.

    Raises
    ------
    ImportError
        If there is no CuPy.
    DeviceError
        If there is no GPU, or if a state of the trial has other bits than the CPU's.
    """
    return _open(open_cupy().cuda.Device().id)


@cache
def _open(_: int) -> Functions:
    functions = Functions(_compile())
    try_bits(functions)
    return functions


def list_options() -> tuple[str, ...]:
    """Return the options of NVRTC. By the digest CuPy's cache knows a changed header."""
    folders = (SHIM, SOURCES, library.FOLDER)
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(each for each in folder.rglob("*") if each.is_file()):
            if path.suffix in ("", *library.SOURCES):
                digest.update(path.read_bytes())
    return (
        *OPTIONS,
        *(f"-I{folder}" for folder in folders),
        f"-DSYMTOP_DIGEST={digest.hexdigest()[:16]}",
    )


def _compile() -> Any:
    module = open_cupy().RawModule(
        code=MAIN.read_text(encoding="utf-8"), options=list_options(), backend="nvrtc"
    )
    with _telling("compiling the kernel for this GPU (once, up to a minute: CuPy keeps it)"):
        module.get_function(FUNCTIONS[0])  # the first one compiles all
    return module


@contextmanager
def _telling(text: str) -> Iterator[None]:
    """Write a line on standard error if the block takes more than a second, and more later."""
    done = threading.Event()

    def tell() -> None:
        if not done.wait(1.0):
            print(f"symtop_ros: {text} ...", file=sys.stderr, flush=True)
        seconds = 1.0
        while not done.wait(PERIOD):
            seconds += PERIOD
            print(f"symtop_ros: ... {seconds:.0f} s", file=sys.stderr, flush=True)

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def try_bits(functions: Functions) -> None:
    """Refuse a device on which a stored motion, of any family, has other bits than on the CPU."""
    rows = np.load(TRIAL)
    starts = np.ascontiguousarray(rows[:, :15])
    times = np.ascontiguousarray(rows[:, 15:])
    asarray = open_cupy().asarray
    motions, _ = functions.prepare(asarray(starts))
    found = functions.read(motions, asarray(times), 1, 1)
    got = tuple(each.get() for each in found)
    different = find_different(compute_on_cpu(starts, times[:, 0]), (got[0], got[1], got[2]))
    if different.any():
        raise DeviceError(
            f"the GPU must have the bits of the CPU, got others in {different.sum()} of "
            f"{len(rows)} motions of the trial (the first: {int(np.argmax(different))}); please "
            "report it with what `python -m symtop_ros.physics.gpu` prints"
        )


def find_different(one: States, other: States) -> NDArray[np.bool_]:
    """Return which states (n,) differ in a bit, or are there in one only; nan is equal to nan."""
    pairs = [
        *((_read_bits(a), _read_bits(b)) for a, b in zip(one[:2], other[:2], strict=True)),
        (np.asarray(one[2]) != 0, np.asarray(other[2]) != 0),
    ]
    count = len(one[0])
    shaped = [(np.reshape(a, (count, -1)), np.reshape(b, (count, -1))) for a, b in pairs]
    different: NDArray[np.bool_] = np.any([(a != b).any(axis=1) for a, b in shaped], axis=0)
    return different


def _read_bits(numbers: Real) -> NDArray[np.int64]:
    """Return doubles as integers, all nan alike: which nan it is says nothing."""
    return np.where(np.isnan(numbers), 0, np.ascontiguousarray(numbers).view(np.int64))


def compute_on_cpu(starts: Real, times: Real) -> States:
    """Return one state of each start (n, 15), at its own time, by the kernel of the CPU."""
    count = len(starts)
    orientation, omega = np.full((count, 4), np.nan), np.full((count, 3), np.nan)
    left = np.empty(count, np.uint8)
    for i in range(count):
        one = slice(i, i + 1)
        bindings.fill_many(starts[one], times[one], orientation[one], omega[one], left[one])
    return orientation, omega, left
