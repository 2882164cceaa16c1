"""Spectral lines in the residuals of a motion, at its own frequencies and at others.

An oscillation at the spin frequency comes from a body that is not symmetric (Iy = 1.02 Ix), or from
a sensor with unequal scales. Whitening would take it for correlated noise.
"""

import numpy as np

from symtop_ros.physics import Motion
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.residuals.lines import Line, find_lines

PHASES = np.arange(64) / 64  # of a nutation, over which the spin is averaged
TWICE = ("spin", "nutation", "precession")
TURN = 2 * np.pi


def list_lines(fit: Fit) -> tuple[Line, ...]:
    """Return the spectral lines in the residuals of a fit, the clearest first.

    The errors of rounding follow the motion and have its frequencies: a line that is no larger
    than they are says nothing.
    """
    kept = fit.noise.kept
    found = find_lines(fit.model.record.times[kept], fit.residuals[kept], name_frequencies(fit))
    rounding = fit.model.record.rounding
    width = fit.residuals.shape[1]  # those of attitudes are no differences of columns
    sizes = rounding if len(rounding) == width else np.full(width, 2 * rounding.max())
    return tuple(line for line in found if line.size > sizes[line.column])


def name_frequencies(fit: Fit) -> dict[str, float]:
    """Return the frequencies in Hz at which residuals of a wrong model oscillate, by name.

    These are the nutation, the precession and their doubles; for records of the body also the spin,
    alone and with the precession. Only few are tried, because a line must be clearer the more are
    tried.
    """
    found = fit.model.find_motion(fit.x)
    motion = Motion(found.top, found.start)  # friction has no periods
    try:
        nutation, precession = TURN / motion.nutation_period, motion.mean_precession_rate
    except ValueError:  # along the separatrix, or through a pole
        return {}
    rates = {"nutation": float(nutation)}
    if not fit.model.lacks_ratio:
        rates["precession"] = float(precession)
    if fit.model.kind.shows_spin:
        times = PHASES * motion.nutation_period
        spin = float(np.mean(motion.at(times).euler_rates.psi_dot))
        rates["spin"] = spin
    if {"spin", "precession"} <= {*rates}:
        rates |= {"sum": spin + precession, "difference": spin - precession}
    rates |= {f"twice_{name}": 2 * rates[name] for name in TWICE if name in rates}
    return {name: abs(rate) / TURN for name, rate in rates.items() if np.isfinite(rate)}
