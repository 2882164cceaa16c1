"""Bits and speeds of this machine's GPU: python -m symtop_ros.physics.gpu [--motions N].

Random motions of all families are compared with the CPU, state by state and bit by bit. Then the
times of the device and of the processor are printed, and the errors of the usual integrator for the
same tops.
"""

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics.gpu import DeviceError, Motions
from symtop_ros.physics.gpu.draw import draw_family, draw_mixed
from symtop_ros.physics.gpu.toolchain import (
    BLOCK,
    SOURCES,
    compute_on_cpu,
    find_different,
    list_options,
    open_cupy,
    open_functions,
)

SEED = 20261126
STEPS = 10_000  # of Runge and Kutta
FEW, EACH = 10_000, 1000  # motions, and states of each
SMALL = 4096  # motions of a usual batch of an engine


def main() -> int:
    """Print bits and speeds; return 1 if a bit differs or there is no GPU."""
    parser = argparse.ArgumentParser(prog="python -m symtop_ros.physics.gpu", description=__doc__)
    parser.add_argument("--motions", type=int, default=1_000_000, help="default: a million")
    count = parser.parse_args().motions
    try:
        _describe()
        different = _compare(*draw_mixed(count, SEED))
        generic, times = draw_family("generic", count, np.random.default_rng(SEED))
        _time_device("generic", generic, times)
        _compare_integrator(generic)
    except (ImportError, DeviceError, ValueError) as error:
        print(f"symtop_ros.physics.gpu: {error}", file=sys.stderr)
        return 1
    return int(different > 0)


def _describe() -> None:
    cupy = open_cupy()
    runtime = cupy.cuda.runtime
    name = runtime.getDeviceProperties(cupy.cuda.Device().id)["name"].decode()
    print(
        f"device: {name}; CUDA {runtime.runtimeGetVersion()}, driver {runtime.driverGetVersion()}"
    )
    began = time.perf_counter()
    functions = open_functions()
    spent = time.perf_counter() - began
    print(
        f"functions: {spent:.1f} s with their trial; a motion takes {functions.motion_bytes} bytes"
    )


def _compare(starts: Real, times: Real) -> int:
    """Compare mixed motions with the CPU; return how many states differ."""
    spent, cpu = _measure(lambda: compute_on_cpu(starts, times), repeats=1)
    found = _time_device("mixed", starts, times)
    got = tuple(each.get() for each in (found.orientation, found.angular_velocity, found.status))
    different = int(find_different(cpu, (got[0], got[1], got[2])).sum())
    written = int((got[2] == 0).sum())
    print(f"bits: {different} of {len(starts)} mixed motions differ ({written} have a state)")
    print(f"CPU: {len(starts) / spent:.2g} motions a second in one thread")
    return different


def _time_device(name: str, starts: Real, times: Real) -> Any:
    """Print the times of set-ups and states; return the first states."""
    cupy = open_cupy()
    columns = [cupy.asarray(each) for each in _split(starts)]
    at = cupy.asarray(times)

    def make(count: int) -> Motions:
        return Motions(
            tuple(each[:count] for each in columns[:3]), tuple(each[:count] for each in columns[3:])
        )

    spent, found = _measure(lambda: make(len(starts)).at_each(at))
    print(f"{name}: {len(starts) / spent:.3g} motions a second with their first states")
    small = min(SMALL, len(starts))
    spent, _ = _measure(lambda: make(small).at_each(at[:small]))
    print(f"{name}: {small} motions in {1e3 * spent:.2f} ms")
    few = make(min(FEW, len(starts)))
    grid = cupy.linspace(-500.0, 1000.0, EACH)
    spent, _ = _measure(lambda: few.at(grid))
    print(f"{name}: {len(few) * EACH / spent:.3g} later states a second")
    return found


def _compare_integrator(starts: Real) -> None:
    """Print the speed and the errors of Runge and Kutta's fourth order on the same device."""
    cupy = open_cupy()
    code = (SOURCES / "rk4.cu").read_text(encoding="utf-8")
    module = cupy.RawModule(code=code, options=list_options(), backend="nvrtc")
    integrate = module.get_function("integrate")
    count = len(starts)
    given = cupy.asarray(starts)
    orientation = cupy.empty((count, 4))
    columns = [cupy.asarray(each) for each in _split(starts)]
    exact = Motions(tuple(columns[:3]), tuple(columns[3:])).at([10.0, 100.0]).orientation
    for k, t in enumerate((10.0, 100.0)):
        sizes = np.int64(count), np.float64(t), np.int64(STEPS)
        grid = ((count + BLOCK - 1) // BLOCK,), (BLOCK,)
        spent, _ = _measure(lambda: integrate(*grid, (given, *sizes, orientation)))  # noqa: B023
        error = _angle_between(orientation.get(), exact[:, k].get())
        print(
            f"Runge-Kutta, {STEPS} steps to {t:g} s: {count / spent:.2g} tops a second; error: "
            f"median {np.median(error):.1g} rad, {np.mean(error > 1e-3):.1%} above 1 mrad"
        )


def _angle_between(one: Real, other: Real) -> Real:
    """Return the angles (n,) between orientations (n, 4), pi where one is no number."""
    sign = np.sign(np.sum(one * other, axis=1, keepdims=True))
    half: Real = np.minimum(np.linalg.norm(one - sign * other, axis=1) / 2, 1)
    angle: Real = 4 * np.arcsin(half)
    return np.where(np.isnan(angle), np.pi, angle)


def _split(starts: Real) -> tuple[Real, ...]:
    """Return the arguments of `Motions` from starts (n, 15)."""
    moments = (np.ascontiguousarray(starts[:, k]) for k in range(3))
    return (
        *moments,
        np.ascontiguousarray(starts[:, 3:7]),
        np.ascontiguousarray(starts[:, 7:10]),
    )


def _measure(work: Callable[[], Any], repeats: int = 3) -> tuple[float, Any]:
    """Return the shortest time of some work (s), and what it returns."""
    synchronize = open_cupy().cuda.Device().synchronize
    times = []
    for _ in range(repeats):
        synchronize()
        began = time.perf_counter()
        found = work()
        synchronize()
        times.append(time.perf_counter() - began)
    return min(times), found


if __name__ == "__main__":
    sys.exit(main())
