"""Print what `top_judge --clock` says of look-ups in tf2, by the rate at which `/tf` is published.

A look-up between two transforms follows the rule of tf2::BufferCore: a slerp of the transform
before the time and the one after it. A look-up of the latest transform returns the one before.
"""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from symtop_ros.base.arrays import Stamps
from symtop_ros.base.measured import format_measured
from symtop_ros.truth.judge.clock import Clock, measure_clock
from symtop_ros.truth.judge.compare import compare
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.topics.estimates import Estimates

SECOND, LOOK_UPS = 1_000_000_000, 2000
TRUTH = scene_truth("cusps")


def look_up(rate: int, times: Stamps) -> tuple[Estimates, Estimates]:
    """Return the interpolated and the latest transforms at times (ns), for a rate (Hz) of /tf."""
    stamps = np.arange(0, int(times[-1]) + 2 * SECOND // rate, SECOND // rate)
    known = TRUTH.states_at(stamps)[0]
    between = Slerp(stamps / SECOND, Rotation.from_quat(known[:, [1, 2, 3, 0]]))
    interpolated = between(times / SECOND).as_quat()[:, [3, 0, 1, 2]]
    latest = known[np.searchsorted(stamps, times, side="right") - 1]
    return Estimates.of(times, interpolated), Estimates.of(times, latest)


def describe_delay(clock: Clock) -> str:
    """Return the delay, with its standard deviation if the errors are noise."""
    return f"late by {format_measured(clock.delay, clock.delay_deviation)} us"


def main() -> None:
    """Print a row for each rate."""
    times = np.sort(np.random.default_rng(1).integers(SECOND, 10 * SECOND, LOOK_UPS))
    for rate in (50, 100, 200, 500, 1000, 2000):
        interpolated, latest = look_up(rate, times)
        error = compare(interpolated, TRUTH).total
        clocks = [measure_clock(each, TRUTH, "tf") for each in (interpolated, latest)]
        late = [describe_delay(each) for each in clocks]
        print(
            f"{rate} Hz: interpolated, {np.sqrt((error**2).mean()):.1e} rad rms, "
            f"{error.max():.1e} at most, {late[0]}; latest, {late[1]}, jitter "
            f"{clocks[1].jitter:.4g} us"
        )


if __name__ == "__main__":
    main()
