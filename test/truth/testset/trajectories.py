"""Tables of trajectories of the test set."""

import numpy as np

from symtop_ros.truth.testset.score import find_problem, read_problems

NAMES = ("t", "w", "x", "y", "z", "wx", "wy", "wz")


def read_exact(name):
    """Times, quaternions and rates in doubles."""
    facts = find_problem(read_problems(), name).facts
    parts = [np.array(facts[key], dtype=float) for key in ("orientations", "angular_velocities")]
    return np.array(facts["times"]), *parts


def make_table(name, error=0.0, seed=1):
    """The columns of an exact trajectory with errors at random."""
    t, q, omega = read_exact(name)
    random = np.random.default_rng(seed)
    q = q + error * random.normal(size=q.shape)
    return np.column_stack((t, q, omega * (1 + error * random.normal(size=omega.shape))))


def write(table, names=NAMES, separator=","):
    rows = [separator.join(map(repr, row)) for row in table.tolist()]
    return "\n".join([separator.join(names), *rows]) + "\n"
