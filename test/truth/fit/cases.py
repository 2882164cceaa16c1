"""Records for the tests of fits: exact motions of which a table or numbers are made."""

import numpy as np
from drawn import Numbers

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit import make_record
from symtop_ros.truth.fit.model import find_axis

CUSPS = Motion(
    Top(Ix=1.0, Iz=0.25, Mgl=300.0), State.from_euler(theta=0.5, phi_dot=1.0, psi_dot=190.0)
)
TIMES = np.arange(240) / 128
SIGMA = 2.0**-8


def make_axis(motion=CUSPS, times=TIMES, sigma=SIGMA, seed=1):
    """Return noisy points of the axis, (n, 3)."""
    exact = find_axis(motion.at(times).orientation)
    return exact + sigma * Numbers(seed).normals(len(times), 3)


def make_noisy(kind, seen, sigma, seed=2, **more):
    """Return a record of exact values and noise."""
    noise = sigma * Numbers(seed).normals(*seen.shape)
    return make_record(TIMES, seen + noise, kind, **more)


def write_table(path, values, times=TIMES, head="t,x,y,z", comma=".", separator=","):
    """Write a table, and return its path."""
    rows = [
        separator.join(f"{each:.9g}".replace(".", comma) for each in (t, *row))
        for t, row in zip(times, values, strict=True)
    ]
    path.write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    return path
