"""Starts for aliases: motions with another nutation that few rows cannot distinguish.

At equal steps a nutation of the frequency f shows the same rows as one of 1/step - f or 1/step + f.
The mean precession stays, and so does the place of the axis in the first row; the velocity of the
nutation grows with its frequency, and is reversed for a positive 1/step - f.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.body_starts import list_spins
from symtop_ros.truth.fit.model import THINNEST, Model, find_momentum
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.fit.starts import Starts, fill

SPARSE = 4.0  # rows in a nutation, below which a different motion may show the same rows
# rows in a nutation; a motion with fewer is excluded if one with SPARSE rows fits as well
NYQUIST = 2.0
SPINS = "rates", "inertial"  # kinds whose rows show the spin itself
RATES = *SPINS, "across"  # kinds of a gyroscope
NEAR = np.linspace(0.8, 1.2, 33)  # factors of p_psi/Ix of a start


def count_rows(fit: Fit) -> float:
    """Return the number of rows in a nutation; infinite if friction or a pole hides it."""
    if fit.model.record.has_friction or fit.model.kind.name in RATES:
        return np.inf
    try:
        return float(fit.model.find_motion(fit.x).nutation_period / fit.model.record.step)
    except (ValueError, TypeError):
        return np.inf


def is_alias(rival: Fit, fit: Fit) -> bool:
    """Return True if the fit has enough rows in a nutation and the other motion too few.

    As everywhere in sampling, the slower motion is taken, unless the rows say otherwise.
    """
    return count_rows(rival) <= NYQUIST and count_rows(fit) >= SPARSE


def list_alias_starts(fit: Fit) -> list[Starts]:
    """Return starts whose nutation has another frequency."""
    model = Model(fit.model.record.plain, fit.model.reference)
    x = fill(model, dict(zip(fit.model.names, fit.x.tolist(), strict=True)))
    motion = model.find_motion(x)
    turning = float(motion.mean_precession_rate)
    rate = 2 * np.pi / float(motion.nutation_period)
    sampling = 2 * np.pi / model.record.step
    rows = [
        _make_start(model, x, ratio * near, turning)
        for ratio in ((rate - sampling) / rate, (rate + sampling) / rate)
        for near in NEAR
    ]
    return [Starts(model, np.array(rows))]


def _make_start(model: Model, x: Real, ratio: float, turning: float) -> Real:
    """Return parameters whose p_psi and velocity of nutation are larger by a ratio."""
    found, place = x.copy(), model.place
    start = model.find_motion(x).start
    w, a, b, c = np.asarray(start.orientation)
    up = Rotation.from_quat([a, b, c, w]).inv().apply([0.0, 0.0, 1.0])
    mean = turning * (up - up[2] * np.array([0.0, 0.0, 1.0]))
    across = np.asarray(start.angular_velocity)[:2] - mean[:2]
    p = find_momentum(model, x) * ratio
    if "p_psi/Ix" in place:
        found[place["p_psi/Ix"]] = p
    else:
        spin = next(iter(list_spins(model.record, x[place["spin"]], p)), x[place["spin"]])
        found[place["spin"]], found[place["Iz/Ix"]] = spin, np.clip(p / spin, THINNEST, 2.0)
    found[place["Mgl/Ix"]] = p * turning - up[2] * turning**2
    found[place["wx"]], found[place["wy"]] = mean[:2] + ratio * across
    return found
