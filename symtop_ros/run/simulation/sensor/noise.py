"""Noise that is the same in every computation: white, and random walks of biases.

Noise is a function of the seed and of the stamp, not of what was computed before. So a log can be
computed again from any of its files, whatever samples were missed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.run.wire.layout import NANOSECONDS

AXES = 3
MAX_NOISE = 1e6
# A random walk is known exactly at multiples of BLOCK ns, and by bridges between them down to
# BLOCK / 2^LEVELS = 65 us; between these points it is straight.
BLOCK_BITS, LEVELS = 40, 24
BLOCK = 1 << BLOCK_BITS  # ns; 18 minutes
LONGEST_WALK = 1 << 57  # ns; four years and a half


@dataclass(frozen=True)
class Noise:
    """The errors of some instruments with three axes each, which are read together."""

    densities: tuple[float, ...]  # white noise of each instrument, per sqrt(Hz)
    walks: tuple[float, ...]  # random walk of its biases, per second and sqrt(Hz)
    seed: int
    rate: float  # samples per second
    begin: int  # stamp in ns at which the biases are zero
    # Streams of numbers: the axes of all instruments for white noise, then for the walks.
    first_stream: int = 0

    def draw(self, stamps: Any) -> Real:
        """Return the errors (..., axes) at stamps."""
        times = np.asarray(stamps, dtype=np.int64)
        errors = self.biases(times)
        sizes = np.repeat([each * math.sqrt(self.rate) for each in self.densities], AXES)
        if any(self.densities):
            white = _normals(self.seed, self._streams(0), times)
            errors += np.moveaxis(sizes.reshape(-1, *[1] * times.ndim) * white, 0, -1)
        return errors

    def biases(self, stamps: Any) -> Real:
        """Return the slow part of the errors: the random walks."""
        times = np.asarray(stamps, dtype=np.int64)
        if not any(self.walks):
            return np.zeros((*times.shape, AXES * len(self.walks)))
        walks = random_walks(self.seed, self._streams(1), times - self.begin)
        return np.asarray(np.moveaxis(walks, 0, -1) * np.repeat(self.walks, AXES))

    def _streams(self, kind: int) -> range:
        count = AXES * len(self.densities)
        return range(self.first_stream + kind * count, self.first_stream + (kind + 1) * count)


def random_walks(seed: int, streams: Sequence[int], times: Any) -> Real:
    """Return random walks that grow by the root of the time in s, and are zero at 0.

    They are built by bridges between known points (Lévy's construction), so that any time is
    computed alone.
    """
    times = np.clip(np.asarray(times, dtype=np.int64), 0, LONGEST_WALK)
    block = times >> BLOCK_BITS
    rest = times & (BLOCK - 1)
    known = np.arange(int(block.max(initial=0)) + 1)
    steps = math.sqrt(BLOCK / NANOSECONDS) * _normals(seed, streams, known << (LEVELS + 2))
    ends = np.concatenate((np.zeros((len(streams), 1)), np.cumsum(steps, axis=1)), axis=1)
    low, high = ends[:, block], ends[:, block + 1]
    walks = low + (high - low) * (rest / BLOCK)
    # The bridges of each level: its number at these times, and how far from its ends they are.
    for level in range(1, LEVELS + 1):  # in this order for any number of times: the same bits
        bits = BLOCK_BITS - level + 1
        inside = (rest & ((1 << bits) - 1)) / (1 << bits)
        sizes = (1 - np.abs(2 * inside - 1)) * np.sqrt((1 << bits) / NANOSECONDS / 4)
        places = (block << (LEVELS + 2)) + (1 << level) + (rest >> bits)
        walks = walks + sizes * _normals_of_runs(seed, streams, places)
    return np.asarray(walks)


def _normals_of_runs(seed: int, streams: Sequence[int], counters: Real) -> Real:
    """Return the normal numbers of counters, computed once for a run of equal ones."""
    flat = np.atleast_1d(counters).ravel()
    begins = np.flatnonzero(np.append(True, flat[1:] != flat[:-1])[: len(flat)])
    lengths = np.diff(np.append(begins, len(flat)))
    found = np.repeat(_normals(seed, streams, flat[begins]), lengths, axis=1)
    return found.reshape(len(streams), *np.shape(counters))


def _normals(seed: int, streams: Sequence[int], counters: Any) -> Real:
    """Return standard normal numbers, (k, ...), one for each stream and counter (...).

    They are a hash, not a sequence: that of SplitMix64 (Steele, Lea and Flood 2014), twice. The
    inverse of the normal distribution makes normal numbers of it.
    """
    # Imported here, because its import takes longer than that of the physics.
    from scipy.special import ndtri  # noqa: PLC0415

    counters = np.asarray(counters).astype(np.uint64)
    numbers = np.array(streams, dtype=np.uint64).reshape(-1, *[1] * counters.ndim)
    keys = _hash(_hash(np.array([seed], dtype=np.uint64))[0] + numbers)
    bits = _hash(_hash(counters) ^ keys)
    return np.asarray(ndtri(((bits >> np.uint64(11)) + 0.5) * 2.0**-53))


def _hash(value: NDArray[np.uint64]) -> NDArray[np.uint64]:
    with np.errstate(over="ignore"):  # products modulo 2^64
        z = value + np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        return np.asarray(z ^ (z >> np.uint64(31)))
