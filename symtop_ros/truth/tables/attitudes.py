"""Attitudes of tables that have no quaternions: rotation matrices, and roll, pitch and yaw."""

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real

#: Orders of roll about x, pitch about y and yaw about z: about the axes of the body, one after the
#: other. ZYX, yaw first, is that of ROS and of aircraft.
ORDERS = {"zyx": ("ZYX", [2, 1, 0]), "xyz": ("XYZ", [0, 1, 2])}
LARGEST = 2 * np.pi  # rad; larger angles without a unit are degrees
SQUARE = 0.1  # of products of a matrix and its transpose, by which a rotation is rounded


def turn_by_angles(angles: Real, order: str, unit: str) -> tuple[Real, str]:
    """Return quaternions w, x, y, z of roll, pitch and yaw (n, 3), and the unit that was taken.

    Without a unit they are radians, unless one is larger than a turn.
    """
    sequence, places = ORDERS[order]
    unit = unit or ("rad" if not len(angles) or np.abs(angles).max() <= LARGEST else "degrees")
    turned = Rotation.from_euler(sequence, angles[:, places], degrees=unit == "degrees")
    return turned.as_quat()[:, [3, 0, 1, 2]], unit


def turn_by_matrices(numbers: Real) -> Real:
    """Return quaternions w, x, y, z of matrices (n, 9) by rows; zeros if one is no rotation."""
    matrices = numbers.reshape(-1, 3, 3)
    far = np.abs(matrices @ matrices.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
    good = (far < SQUARE) & (np.linalg.det(matrices) > 0)
    found = np.zeros((len(numbers), 4))
    if good.any():
        found[good] = Rotation.from_matrix(matrices[good]).as_quat()[:, [3, 0, 1, 2]]
    return found
