"""Noise of attitudes, as rotation vectors (n, 3) about the axes of the body or of the world."""

import math
from collections.abc import Callable
from random import Random

import numpy as np

from workshop.judge.motion import Real

SIZES = 5e-4, 2e-3, 1e-2  # rad
LONGEST = 1.0  # part of the record in which flicker is slowest
OUTLYING = 0.01  # of the estimates


def draw_white(random: Random, times: Real) -> Real:
    """Return normal numbers."""
    return np.array([[random.gauss(0, 1) for _ in range(3)] for _ in times])


def draw_lasting(random: Random, times: Real) -> Real:
    """Return an autoregression of first order of 5 to 300 ms."""
    lasts = math.exp(random.uniform(math.log(0.005), math.log(0.3)))
    new, found = draw_white(random, times), np.empty((len(times), 3))
    found[0] = new[0]
    for k in range(1, len(times)):
        kept = math.exp(-(times[k] - times[k - 1]) / lasts)
        found[k] = kept * found[k - 1] + math.sqrt(1 - kept**2) * new[k]
    return found


def draw_flicker(random: Random, times: Real) -> Real:
    """Return a sum of swings whose power goes with 1/f, from the length of the record on."""
    span = times[-1] - times[0]
    found = np.zeros((len(times), 3))
    for k in range(1, len(times) // 2):
        phases = 2 * math.pi * k / (2 * LONGEST * span) * (times - times[0])
        for axis in range(3):
            size = random.gauss(0, 1), random.gauss(0, 1)
            found[:, axis] += (size[0] * np.cos(phases) + size[1] * np.sin(phases)) / math.sqrt(k)
    return found / math.sqrt(float((found**2).sum(axis=1).mean()) / 3)


def draw_swing(random: Random, times: Real) -> Real:
    """Return a sinusoid of 0.3 to 20 Hz about one axis, and a fifth of white noise."""
    frequency = math.exp(random.uniform(math.log(0.3), math.log(20.0)))
    found = 0.2 * draw_white(random, times)
    phase = random.uniform(-3, 3)
    found[:, random.randrange(3)] += 2 * np.sin(2 * math.pi * frequency * times + phase)
    return found


def draw_outlying(random: Random, times: Real) -> Real:
    """Return normal numbers, of which one of a hundred is a thousand times larger."""
    found = draw_white(random, times)
    for place in random.sample(range(len(times)), max(1, round(OUTLYING * len(times)))):
        found[place] *= 1000.0
    return found


NOISES: dict[str, Callable[[Random, Real], Real]] = {
    "white": draw_white,
    "AR(1)": draw_lasting,
    "flicker": draw_flicker,
    "sinusoid": draw_swing,
    "outliers": draw_outlying,
}
