"""The parts of a torque on a top that the outer ring of its gimbal and the stand exert."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.physics.values import validate_vectors


@dataclass(frozen=True, eq=False, slots=True)
class GimbalShares:
    """The parts of a torque (N m) or an angular impulse (N m s) on a top in a gimbal.

    Attributes
    ----------
    ring : float or ndarray (...)
        Part about the vertical, about which the outer ring turns: a hand at the ring gives it. It
        has a sign.
    stand : float or ndarray (...)
        Size of the horizontal part: the bearing of the ring in the stand gives it.
    """

    ring: Real
    stand: Real


def gimbal_shares(torque: ArrayLike) -> GimbalShares:
    """Return the parts of a torque on a top that the outer ring and the stand exert.

    The outer ring turns about the vertical, so a hand at the ring can exert only the vertical part
    of a torque. The bearing of the ring exerts the rest.

    Parameters
    ----------
    torque : array_like (3,) or (..., 3)
        In the world frame, in N m; or an angular impulse in N m s.

    Returns
    -------
    GimbalShares

    Raises
    ------
    ValueError
        If the torque is refused.

    Examples
    --------
    While a hand holds the precession, p_psi theta' acts on the top across its axis. The hand feels
    only the part p_psi theta' sin(theta), and nothing when the axis points down (derivation,
    section 11):

    >>> from symtop_ros.physics import Motion, State, Top, gimbal_shares
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> held = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0), clamped=True)
    >>> for t in (0.05, 0.1):
    ...     shares = gimbal_shares(held.added_torque(held.at(t)))
    ...     print(f"ring {shares.ring:.4f} N m, stand {shares.stand:.4f} N m")
    ring -0.0576 N m, stand 0.0700 N m
    ring -0.2245 N m, stand 0.0468 N m
    """
    x, y, z = np.moveaxis(np.asarray(validate_vectors("torque", torque, "world frame")), -1, 0)
    return GimbalShares(ring=z[()], stand=np.hypot(x, y))
