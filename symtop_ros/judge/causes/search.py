"""Costs of many delays and drifts at once: where the search for causes starts.

For a constant rotation of one frame the least squares are an eigenvalue of a matrix of four rows
(Markley et al. 2007), and for rotations of both frames nearly so after the turns from one estimate
to the next are aligned (the hand-eye problem, Park and Martin 1994).

Constant rotations of both frames between exact attitudes and estimates come in closed form.
"""

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.judge.compare import IDENTITY, NONE, Offset, to_rotation

# Which rotations are free, with their columns of derivatives, and how much each counts when the
# simplest explanation is looked for.
LEVELS: dict[str, tuple[tuple[int, ...], float]] = {
    "none": ((), 0.0),
    "heading": ((2,), 1.0),
    "world": ((0, 1, 2), 2.5),
    "body": ((3, 4, 5), 2.5),
    "both": ((0, 1, 2, 3, 4, 5), 5.0),
}
FLIPS = np.eye(4)  # no turn, and half turns about x, y and z


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
        return fit_level(self.estimates[place][known], self.exact[place][known], level)

    def _guess_bodies(self) -> Real:
        ours, theirs = _turns(self.estimates), _turns(self.exact)
        both = (self.known[:, 1:] * self.known[:, :-1])[..., np.newaxis]
        u, _, vt = np.linalg.svd(np.swapaxes(theirs * both, 1, 2) @ (ours * both))
        u[..., -1] *= np.linalg.det(u @ vt)[:, np.newaxis]
        # a rotation matrix R with theirs = R ours
        q = Rotation.from_matrix(u @ vt).as_quat()
        return np.asarray(q[:, np.newaxis, [3, 0, 1, 2]])


def _turns(q: Real) -> Real:
    """Return rotation vectors from each attitude to the next, (g, n - 1, 3)."""
    return find_rotation_vectors(compose(invert(q[:, :-1]), q[:, 1:]))


def fit_level(q: Real, exact: Real, level: str) -> Offset:
    """Return the best rotations of a level, for estimates (n, 4) and exact attitudes."""
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


def find_valleys(costs: Real, most: int) -> list[int]:
    """Return the places of some valleys of a table of costs, the deepest first."""
    padded = np.concatenate(([np.inf], costs, [np.inf]))
    valleys = np.flatnonzero((costs <= padded[:-2]) & (costs <= padded[2:]))
    found: list[int] = valleys[np.argsort(costs[valleys])][:most].tolist()
    return found


def _mean(q: Real) -> Real:
    """Return the mean of rotations, (4,)."""
    mean: Real = np.linalg.eigh(q.T @ q)[1][:, -1]
    return np.asarray(mean * np.copysign(1.0, mean[0]))


def fit_rotations(q: Real, exact: Real) -> Offset:
    """Return the rotations W and M for which W exact M is nearest to q.

    Both together are one rotation of the four components of a quaternion, found by Kabsch's method
    (a singular value decomposition). The signs of the quaternions follow from a first guess; a top
    that turns about one axis leaves it open, so half turns of the body are tried as well.
    """
    guesses = [_guess_rotations(q, exact), *(_align_world(q, exact, body) for body in FLIPS)]
    found = [_improve(q, exact, guess) for guess in guesses]
    return min(found, key=lambda each: _measure(q, exact, each))


def _measure(q: Real, exact: Real, offset: Offset) -> float:
    """Return the mean square of what is left, nearly, and a little more for large rotations."""
    images = compose(compose(offset.world, exact), offset.body)
    left = 1 - float(((images * q).sum(axis=1) ** 2).mean())
    return left + 1e-12 * sum(offset.angles)


def _improve(q: Real, exact: Real, guess: Offset) -> Offset:
    images = compose(compose(guess.world, exact), guess.body)
    signs = np.where((images * q).sum(axis=1) < 0, -1.0, 1.0)
    u, _, vt = np.linalg.svd((q * signs[:, np.newaxis]).T @ exact)
    u[:, -1] *= np.sign(np.linalg.det(u @ vt))  # a rotation, not a reflection
    # The images of 1, i, j, k: (W i M) (W 1 M)^-1 = W i W^-1 is a column of W's matrix.
    images = (u @ vt).T
    columns = compose(images[1:], invert(images[0]))[:, 1:]
    world = to_quaternion(Rotation.from_matrix(columns.T))
    body = compose(invert(world), images[0])
    return Offset(world, body * np.copysign(1.0, body[0]))


def _guess_rotations(q: Real, exact: Real) -> Offset:
    """Return W and M by a way that does not ask for the signs of the quaternions.

    The turns from one estimate to the next have the same angles as the exact ones, about axes that
    M has turned (the hand-eye problem, Park and Martin 1994). W is then a mean of rotations, the
    eigenvector of the largest eigenvalue (Markley et al. 2007).
    """
    ours = to_rotation(compose(invert(q[:-1]), q[1:])).as_rotvec()
    theirs = to_rotation(compose(invert(exact[:-1]), exact[1:])).as_rotvec()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a top at rest leaves M open
        body = to_quaternion(Rotation.align_vectors(theirs, ours)[0])
    return _align_world(q, exact, body)


def _align_world(q: Real, exact: Real, body: Real) -> Offset:
    """Return the best rotation of the world for one of the body."""
    left = compose(q, invert(compose(exact, body)))
    return Offset(np.linalg.eigh(left.T @ left)[1][:, -1], body)


def from_vector(vector: Real) -> Real:
    """Return the quaternion of a rotation vector."""
    return to_quaternion(Rotation.from_rotvec(vector))


def to_quaternion(rotation: Rotation) -> Real:
    """Return w, x, y, z with w >= 0."""
    x, y, z, w = rotation.as_quat()
    q: Real = np.array((w, x, y, z)) * np.copysign(1.0, w)
    return q
