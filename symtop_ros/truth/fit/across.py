"""Two constants of a motion from the rates across the axis alone, without the spin.

With W = wx + i wy, the vertical G = gx + i gy and gz, all in the frame of the body, r = Iz/Ix and
m = Mgl/Ix, Euler's equations and those of the vertical are

    W' = i (r - 1) wz W - i m G,    G' = -i wz G + i gz W,    gz' = -Im(conj(W) G).

So m gz + |W|^2/2 is constant, and W'' = -i k W' + (e - |W|^2/2) W with

    k = (2 - r) wz,    e = m gz + |W|^2/2 - (r - 1) wz^2.

For each r there is one motion with the same k, e, W and W' at the start.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit.model import THINNEST

PAD = 8  # factor by which padding with zeros makes a spectrum finer


@dataclass(frozen=True)
class Across:
    """The constants k and e of a motion, with W and W' at its start."""

    k: float
    e: float
    w: complex
    slope: complex

    @classmethod
    def of(cls, motion: Motion) -> "Across":
        """Return the constants of a motion."""
        start, top = motion.start, motion.top
        x, y, spin = np.asarray(start.angular_velocity).tolist()
        gx, gy, gz = (top.Mgl / top.Ix * np.asarray(start.to_body([0.0, 0.0, 1.0]))).tolist()
        ratio, w = top.Iz / top.Ix, complex(x, y)
        e = gz + abs(w) ** 2 / 2 - (ratio - 1) * spin**2
        slope = 1j * ((ratio - 1) * spin * w - complex(gx, gy))
        return cls((2 - ratio) * spin, e, w, slope)

    def find_motion(self, ratio: float) -> Motion:
        """Return the motion of the top with this Iz/Ix and Ix = 1, with phi = 0 at the start."""
        spin = self.k / max(2 - ratio, THINNEST)
        across = 1j * self.slope + (ratio - 1) * spin * self.w
        along = self.e - abs(self.w) ** 2 / 2 + (ratio - 1) * spin**2
        vertical = np.array([across.real, across.imag, along])
        start = State(turn_upright(vertical), (self.w.real, self.w.imag, spin))
        return Motion(Top(1.0, ratio, float(np.linalg.norm(vertical))), start)


def measure_across(times: Real, w: Any) -> Across:
    """Return the constants that rates (n,) at some times show, by linear least squares.

    W'', integrated twice, is linear in the constants, and no noise is differentiated. W turns by up
    to some rad from row to row, so it is seen from a frame that turns with its strongest frequency:
    there V = W exp(-i c t) has the same equation with k + 2 c and e + k c + c^2.
    """
    t = times - times[0]
    c = find_frequency(t, w)
    seen = _measure(t, w * np.exp(-1j * c * t))
    k = seen.k - 2 * c
    return Across(k, seen.e - c * (k + c), seen.w, seen.slope + 1j * c * seen.w)


def find_frequency(times: Real, w: Any) -> float:
    """Return the angular frequency with the most power in complex rows, at equal steps."""
    power = np.abs(np.fft.fft(w, PAD * len(w)))
    step = float(np.median(np.diff(times)))
    return float(2 * np.pi * np.fft.fftfreq(PAD * len(w), step)[int(np.argmax(power))])


def _measure(times: Real, w: Any) -> Across:
    steps = np.diff(times)

    def add(rows: Any) -> Any:
        return np.concatenate([[0.0], np.cumsum((rows[1:] + rows[:-1]) / 2 * steps)])

    one, turn = np.ones(len(w), dtype=complex), 1j
    found = [-turn * add(w - w[0]), add(add(w)), one, turn * one, times * one, turn * times]
    left = w + add(add(np.abs(w) ** 2 * w)) / 2
    columns = np.stack([np.concatenate([each.real, each.imag]) for each in found], axis=1)
    right = np.concatenate([left.real, left.imag])
    k, e, a, b, c, d = np.linalg.lstsq(columns, right, rcond=None)[0].tolist()
    return Across(k, e, complex(a, b), complex(c, d))


def turn_upright(vertical: Real) -> Real:
    """Return the quaternion of the smallest rotation that takes a vector to the z axis."""
    x, y, z = map(float, vertical)
    across = math.hypot(x, y)
    half = math.atan2(across, z) / 2
    a, b = (y / across, -x / across) if across else (1.0, 0.0)
    return np.array([math.cos(half), a * math.sin(half), b * math.sin(half), 0.0])
