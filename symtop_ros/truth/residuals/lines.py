"""Lines in the spectrum of residuals: oscillations of one frequency.

An autoregression takes a line for correlated noise, and whitens it away, so lines are tested first.
The test is Thomson's F-test for lines (Spectrum estimation and harmonic analysis, 1982, section
XIII; Percival and Walden, Spectral Analysis for Physical Applications, 1993, section 10.11). It
compares the power of a line in several tapered transforms with what the line leaves of them, all
within a few steps of frequency, so that it holds for noise of any smooth spectrum, and its false
alarms are known: without a line F has 2 and 2 K - 2 degrees of freedom.

Tapers are sines (Riedel and Sidorenko, Minimum bias multiple taper spectral estimation, 1995) at
the times of the rows, made orthogonal again: rows may be missing, or be unevenly spaced. What a fit
has absorbed of a line is missing, which makes alarms fewer.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Mask, Real

TAPERS = 7
WIDTH = (TAPERS + 1) / 2  # half of their band, in steps of frequency 1/T
FEWEST = 64  # rows; in fewer a band is a large part of all frequencies
CHANCE = 1e-3  # of a false alarm in a record
FINER = 8  # frequencies for each step, of a search: a line in the middle of two is hardly seen
LONGEST = 16  # steps of time for each row, of a search
NEAR = np.arange(-4, 5) / FINER  # steps of frequency next to a given one
SMALL = 1e-300
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Line:
    """An oscillation of residuals at one frequency.

    Attributes
    ----------
    name : str
        Name of a given frequency; "" if the line was found in a search.
    frequency : float
        In Hz, below half of the sampling.
    column : int
        Column of the residuals.
    size : float
        Root mean square of the swing.
    share : float
        Part of the power of the column.
    chance : float
        Chance of such a line, or a clearer one, in noise, in all that were tried.
    """

    name: str
    frequency: float
    column: int
    size: float
    share: float
    chance: float


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Tapered transforms of residuals (n, r) at times (n,) in s."""

    times: Real
    left: Real

    @cached_property
    def step(self) -> float:
        """Median of the steps of time, in s."""
        return float(np.median(np.diff(self.times)))

    @cached_property
    def resolution(self) -> float:
        """Step of frequency 1/T, in Hz."""
        return float(1 / (self.times[-1] - self.times[0] + self.step))

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest testable frequency: half a band from 0 and from half the sampling."""
        width = WIDTH * self.resolution
        return width, 0.5 / self.step - width

    @cached_property
    def tapers(self) -> Real:
        """Tapers (n, K), orthonormal at the times of the rows."""
        since = self.times - self.times[0] + self.step
        phases = np.pi * since / (since[-1] + self.step)
        found = np.sin(np.multiply.outer(phases, np.arange(1, TAPERS + 1)))
        return np.asarray(np.linalg.qr(found)[0])

    @cached_property
    def _tapered(self) -> Real:
        """Residuals less their mean, tapered, (n, K, r)."""
        left = self.left - self.left.mean(axis=0)
        return np.asarray(self.tapers[:, :, np.newaxis] * left[:, np.newaxis])

    def fold(self, frequency: float) -> float:
        """Return where a frequency is seen at this sampling, between 0 and half of it."""
        sampling = 1 / self.step
        return float(abs(frequency - sampling * np.round(frequency / sampling)))

    def test(self, frequencies: Real) -> tuple[Real, Real]:
        """Return the chances (f, r) of lines at frequencies (f,) in noise, and their sizes."""
        waves = np.exp(-2j * np.pi * np.outer(frequencies, self.times - self.times[0]))
        return self._compare(np.einsum("ft,tkr->fkr", waves, self._tapered))

    def scan(self) -> tuple[Real, Real, Real]:
        """Return all frequencies (f,) that can be tried, and chances and sizes (f, r)."""
        places = np.rint((self.times - self.times[0]) / self.step).astype(int)
        count = FINER * (int(places[-1]) + 1)
        grid = np.zeros((count, *self._tapered.shape[1:]))
        np.add.at(grid, places, self._tapered)
        frequencies = np.arange(count // 2 + 1) / (count * self.step)
        some = self.is_tried(frequencies)
        chances, sizes = self._compare(np.fft.rfft(grid, axis=0)[some])
        return np.asarray(frequencies[some]), chances, sizes

    def is_tried(self, frequencies: Real) -> Mask:
        """Return whether lines at frequencies (f,) can be tried."""
        low, high = self.ends
        return np.asarray((frequencies >= low) & (frequencies <= high))

    def _compare(self, transforms: Complex) -> tuple[Real, Real]:
        """Return the chances and sizes (f, r) of transforms (f, K, r).

        With 2 and 2 m degrees of freedom F is larger than a number with the chance (1 + F/m)^-m.
        """
        sums = self.tapers.sum(axis=0)  # transforms of a line of size one
        weight = float(sums @ sums)
        line = np.einsum("fkr,k->fr", transforms, sums) / weight
        rest = transforms - line[:, np.newaxis] * sums[:, np.newaxis]
        noise = (np.abs(rest) ** 2).sum(axis=1)
        ratio = weight * np.abs(line) ** 2 / np.maximum(noise, SMALL)
        return np.asarray((1 + ratio) ** (1 - TAPERS)), np.asarray(np.sqrt(2) * np.abs(line))


def find_lines(times: Real, left: Real, named: Mapping[str, float]) -> tuple[Line, ...]:
    """Return the lines at given frequencies, and the clearest one at any other.

    Parameters
    ----------
    times : ndarray (n,)
        In s.
    left : ndarray (n, r)
        Residuals.
    named : mapping
        Frequencies in Hz that may be above half of the sampling, by their names: they are tried
        first, as a search among all needs a clearer line.

    Returns
    -------
    tuple of Line
        The clearest first. Each of two tries has half of the chance of a false alarm.
    """
    if len(times) < FEWEST:
        return ()
    spectrum = Spectrum(times, left)
    low, high = spectrum.ends
    if not low < high:
        return ()
    found = [*_find_named(spectrum, named)]
    other = _find_other(spectrum)
    if other and all(abs(other.frequency - each.frequency) > low for each in found):
        found.append(other)
    return tuple(sorted(found, key=lambda each: each.chance))


def _find_named(spectrum: Spectrum, named: Mapping[str, float]) -> Iterator[Line]:
    """Yield the lines at given frequencies; of two within a band of each other the clearer one."""
    folded = {name: spectrum.fold(each) for name, each in named.items()}
    tried = {name: each for name, each in folded.items() if spectrum.is_tried(np.array(each))}
    lines = []
    for name, frequency in tried.items():
        frequencies = frequency + NEAR * spectrum.resolution
        found = _choose(spectrum, name, frequencies, *spectrum.test(frequencies), len(tried))
        lines += [found] if found else []
    kept: list[Line] = []
    for each in sorted(lines, key=lambda each: each.chance):
        if all(abs(each.frequency - other.frequency) > spectrum.ends[0] for other in kept):
            kept.append(each)
            yield each


def _find_other(spectrum: Spectrum) -> Line | None:
    """Return the clearest line at any frequency; of a record with long gaps none is looked for."""
    steps = (spectrum.times[-1] - spectrum.times[0]) / spectrum.step
    if steps > LONGEST * len(spectrum.times):
        return None
    return _choose(spectrum, "", *spectrum.scan(), 1)


def _choose(
    spectrum: Spectrum, name: str, frequencies: Real, chances: Real, sizes: Real, tries: int
) -> Line | None:
    """Return the clearest line, if noise hardly has one as clear in all that were tried."""
    place, column = np.unravel_index(int(chances.argmin()), chances.shape)
    chance = float(chances[place, column]) * chances.size * tries
    if chance > CHANCE / 2:
        return None
    size = float(sizes[place, column])
    power = float(spectrum.left[:, column].var())
    share = min(size**2 / max(power, SMALL), 1.0)
    return Line(name, float(frequencies[place]), int(column), size, share, chance)
