"""What a cause leaves of the errors: its strongest line, a swing of one frequency."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.alignment import Alignment
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.residuals.lines import Line, find_lines

SMALL = 0.3  # part of what is left, below which a line is not said
SLOW = np.arange(10, 40) / 8  # turns in the run of swings that are too slow for a test
NEARLY_ALL = 0.7  # part of the power of a component that such a swing has
# Components of what is left: in the frame of the body, then in the world.
ABOUT = ("across_axis", "across_axis", "axis", "horizontal", "horizontal", "vertical")


@dataclass(frozen=True)
class Swing:
    """A line of what is left.

    Attributes
    ----------
    frequency : float
        In Hz.
    resolution : float
        Steps of frequency that the run tells apart, in Hz.
    size : float
        Root mean square of the swing in rad.
    about : str
        The `axis` of the body or an axis across it (`across_axis`), the `vertical` or a
        `horizontal` axis of the world.
    name : str
        `nutation`, `spin` or `precession` of the motion; "" for none of these.
    """

    frequency: float
    resolution: float
    size: float
    about: str
    name: str


def find_swing(fit: Alignment, offset: Offset) -> Swing | None:
    """Return the strongest line of what an offset leaves, if noise hardly has it."""
    stamps = fit.some.stamps[fit.exact(offset)[1]]
    stamps, firsts = np.unique(stamps, return_index=True)
    if len(stamps) < 2:
        return None
    seconds = (stamps - stamps[0]) / NANOSECONDS
    left = np.hstack(fit.find_remainder(offset).frames[::-1])[firsts]
    found = [*find_lines(seconds, left, fit.truth.frequencies), *_find_slow(seconds, left)]
    most = len(seconds) / (2 * seconds[-1])  # stamps in pairs have short steps and long ones
    found = [each for each in found if each.frequency <= most]
    line = max(found, key=lambda each: each.size, default=None)
    if line is None or line.size < SMALL * fit.find_remainder(offset).rms:
        return None
    resolution = 1 / float(seconds[-1])
    return Swing(line.frequency, resolution, line.size, ABOUT[line.column], line.name)


def _find_slow(seconds: Real, left: Real) -> Iterator[Line]:
    """Yield the clearest swing of fewer turns than a line needs, if it is nearly all of a column.

    Noise that lasts has swings of one or two turns as well: it is no test of a line.
    """
    phases = math.tau * np.outer(SLOW, seconds / seconds[-1])
    power = (left**2).sum(axis=0) + np.finfo(float).tiny
    tried = []
    for place, phase in enumerate(phases):
        waves = np.stack((np.ones_like(phase), np.cos(phase), np.sin(phase)), axis=1)
        basis, triangle = np.linalg.qr(waves)
        sizes = basis.T @ left
        share = (sizes**2).sum(axis=0) / power
        column = int(share.argmax())
        swing = waves[:, 1:] @ np.linalg.solve(triangle, sizes[:, column])[1:]
        tried.append((float(share[column]), place, column, float(np.sqrt((swing**2).mean()))))
    share, place, column, size = max(tried)
    if share > NEARLY_ALL and size**2 * len(left) > NEARLY_ALL * power.max() / 2:
        frequency = float(SLOW[place] / seconds[-1])
        yield Line("", frequency, column, size, share, 1.0)
