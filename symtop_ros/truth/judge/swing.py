"""The strongest spectral line in the residuals of a cause."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.alignment import Alignment
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.residuals.lines import find_lines

SMALL = 0.3  # part of the residuals, below which a line is not named
SLOW = np.arange(10, 40) / 8  # turns in the run of swings that are too slow for a test
NEARLY_ALL = 0.7  # part of the power of a component that such a swing has
# Components of the residuals: in the frame of the body, then in the world.
ABOUT = ("across_axis", "across_axis", "axis", "horizontal", "horizontal", "vertical")


@dataclass(frozen=True)
class Swing:
    """A spectral line of the residuals.

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
    """Return the strongest line of the residuals of an offset, if noise hardly explains it."""
    stamps = fit.some.stamps[fit.exact(offset)[1]]
    stamps, firsts = np.unique(stamps, return_index=True)
    if len(stamps) < 2:
        return None
    seconds = (stamps - stamps[0]) / NANOSECONDS
    left = np.hstack(fit.find_remainder(offset).frames[::-1])[firsts]
    lines = find_lines(seconds, left, fit.truth.frequencies)
    most = len(seconds) / (2 * seconds[-1])  # stamps in pairs have short steps and long ones
    found = {each.frequency: each.name for each in lines if each.frequency <= most}
    found |= dict.fromkeys(_find_slow(seconds, left), "")
    sizes = {each: measure_swings(seconds, left, each) for each in found}
    frequency = max(sizes, key=lambda each: float(sizes[each].max()), default=None)
    if frequency is None or sizes[frequency].max() < SMALL * fit.find_remainder(offset).rms:
        return None
    column = int(sizes[frequency].argmax())
    resolution, size = 1 / float(seconds[-1]), float(sizes[frequency][column])
    return Swing(frequency, resolution, size, ABOUT[column], found[frequency])


def measure_swings(seconds: Real, left: Real, frequency: float) -> Real:
    """Return root mean squares of swings of a frequency in columns (n, r), apart from constants."""
    phase = math.tau * frequency * seconds
    waves = np.stack((np.ones_like(phase), np.cos(phase), np.sin(phase)), axis=1)
    basis, triangle = np.linalg.qr(waves)
    swings = waves[:, 1:] @ np.linalg.solve(triangle, basis.T @ left)[1:]
    return np.asarray(np.sqrt((swings**2).mean(axis=0)))


def _find_slow(seconds: Real, left: Real) -> Iterator[float]:
    """Yield the frequency of a swing of fewer turns than a line needs, if it is nearly all.

    Correlated noise has such oscillations, too, so this is no test for a line.
    """
    tried = SLOW / seconds[-1]
    sizes = np.array([measure_swings(seconds, left, each) for each in tried])
    place, column = np.unravel_index(int(sizes.argmax()), sizes.shape)
    if sizes[place, column] ** 2 > NEARLY_ALL * left[:, column].var():
        yield float(tried[place])
