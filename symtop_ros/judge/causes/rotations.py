"""Constant rotations of world and body between exact attitudes and estimates, in closed form."""

import warnings

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.arrays import Real
from symtop_ros.judge.compare import Offset, to_rotation
from symtop_ros.quaternions import compose, invert

FLIPS = np.eye(4)  # no turn, and half turns about x, y and z


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
