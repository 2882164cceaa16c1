"""Costs of many delays and drifts at once: where the search for causes starts.

For a constant rotation of one frame the least squares are an eigenvalue of a matrix of four rows
(Markley et al. 2007), and for rotations of both frames nearly so after the turns from one estimate
to the next are aligned (the hand-eye problem, Park and Martin 1994).
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.causes.rotations import fit_rotations
from symtop_ros.judge.compare import IDENTITY, NONE, Offset, to_rotation
from symtop_ros.quaternions import compose, invert

# Which rotations are free, with their columns of derivatives, and how much each counts when the
# simplest explanation is looked for.
LEVELS: dict[str, tuple[tuple[int, ...], float]] = {
    "none": ((), 0.0),
    "heading": ((2,), 1.0),
    "world": ((0, 1, 2), 2.5),
    "body": ((3, 4, 5), 2.5),
    "both": ((0, 1, 2, 3, 4, 5), 5.0),
}


@dataclass(frozen=True, eq=False)
class Table:
    """Estimates (g, n, 4) and exact attitudes (g, n, 4) for g values of a parameter."""

    values: Real  # (g,)
    estimates: Real
    exact: Real
    known: Real  # (g, n): 1.0 where the exact motion is known, else 0.0

    def costs(self, level: str) -> Real:
        """Return about the mean squares of the half angles that are left, (g,)."""
        counts = self.known.sum(axis=1)
        if level == "both":
            left = compose(self.estimates, invert(compose(self.exact, self._guess_bodies())))
        elif level == "body":
            left = compose(invert(self.exact), self.estimates)
        else:
            left = compose(self.estimates, invert(self.exact))
        chosen = {"none": [0], "heading": [0, 3]}.get(level, [0, 1, 2, 3])
        left = (left * self.known[..., np.newaxis])[..., chosen]
        largest = np.linalg.eigvalsh(np.swapaxes(left, 1, 2) @ left)[:, -1]
        enough = counts >= max(2, self.known.shape[1] // 2)
        costs = 1 - largest / np.maximum(counts, 1)
        return np.asarray(np.where(enough, np.maximum(costs, 0.0), np.inf))

    def start(self, place: int, level: str) -> Offset:
        """Return the best rotations of a level for one value."""
        known = self.known[place] > 0
        q, exact = self.estimates[place][known], self.exact[place][known]
        if level == "both":
            return fit_rotations(q, exact)
        if level == "none":
            return NONE
        if level == "body":
            return Offset(IDENTITY, _mean(compose(invert(exact), q)))
        left = compose(q, invert(exact))
        if level == "heading":
            left = left * np.array([1.0, 0.0, 0.0, 1.0])
        return Offset(_mean(left), IDENTITY)

    def _guess_bodies(self) -> Real:
        ours, theirs = _turns(self.estimates), _turns(self.exact)
        both = (self.known[:, 1:] * self.known[:, :-1])[..., np.newaxis]
        u, _, vt = np.linalg.svd(np.swapaxes(theirs * both, 1, 2) @ (ours * both))
        u[..., -1] *= np.linalg.det(u @ vt)[:, np.newaxis]
        # a rotation matrix R with theirs = R ours
        q = type(to_rotation(IDENTITY)).from_matrix(u @ vt).as_quat()
        return np.asarray(q[:, np.newaxis, [3, 0, 1, 2]])


def _turns(q: Real) -> Real:
    """Return rotation vectors from each attitude to the next, (g, n - 1, 3)."""
    step = compose(invert(q[:, :-1]), q[:, 1:])
    step = step * np.where(step[..., :1] < 0, -1.0, 1.0)
    sine = np.linalg.norm(step[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, step[..., :1])
    return np.asarray(step[..., 1:] * angle / np.where(sine > 0, sine, 1.0))


def _mean(q: Real) -> Real:
    """Return the mean of rotations, (4,)."""
    mean: Real = np.linalg.eigh(q.T @ q)[1][:, -1]
    return np.asarray(mean * np.copysign(1.0, mean[0]))
