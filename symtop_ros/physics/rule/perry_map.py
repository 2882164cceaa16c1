"""Perry's rule for a map: the same tops without a kick and with it, many at once."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import RULES, Hold
from symtop_ros.physics.kicks import HOLDS, validate_hold
from symtop_ros.physics.precession import spread_tops
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import validate_array, validate_number, validate_rate


@dataclass(frozen=True, eq=False)
class HurryEffect:
    """Tops with theta' = 0, compared with the same tops hurried.

    Attributes
    ----------
    before, after : ndarray (2, ...)
        Turning angles without the kick and with it, smallest theta first, in rad.
    rule_applies : ndarray (...) of bool
        False where Perry's rule says nothing: for phi' = 0, for Mgl = 0, on the vertical, for a
        factor that is 1 or negative, and where theta'' is the same with the kick as without it.
    rule_holds : ndarray (...) of bool
        True where Perry's rule holds, as defined in `perrys_rule`.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> effect = compare_hurried(top, theta=0.5, phi_dot=9.0, psi_dot=200.0)
    >>> bool(effect.rise > 0)
    True
    """

    before: Real
    after: Real
    rule_applies: NDArray[np.bool_]
    rule_holds: NDArray[np.bool_]

    @property
    def rise(self) -> Real:
        """Rise of the highest point, (...), in rad; negative where it is lower with the kick."""
        return np.asarray(self.before[0] - self.after[0])

    @property
    def fall(self) -> Real:
        """Fall of the lowest point, (...), in rad; negative where it is higher with the kick."""
        return np.asarray(self.after[1] - self.before[1])


def compare_hurried(
    top: Top,
    theta: ArrayLike,
    phi_dot: ArrayLike,
    psi_dot: ArrayLike,
    factor: float = 1.4,
    hold: Hold = "spin_rate",
) -> HurryEffect:
    """Return the effect of hurrying the precession by a factor, for many tops at once.

    Parameters
    ----------
    top : Top
        One top, or many of a shape that fits the other arguments.
    theta, phi_dot, psi_dot : array_like, broadcast to (...)
        Tilt in rad, precession and spin rate in rad/s; theta' is 0.
    factor : float
        The kick multiplies phi' by it.
    hold : {"spin_rate", "spin_momentum"}
        The quantity that the kick holds, as in `set_precession_rate`.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> compare_hurried(top, 0.5, [6.5, 69.8], 200.0).rule_holds.tolist()
    [True, False]
    """
    factor, held = validate_number("factor", factor), HOLDS.index(validate_hold(hold))
    given = (
        validate_array("theta", theta, unit="rad"),
        validate_rate("phi_dot", phi_dot),
        validate_rate("psi_dot", psi_dot),
    )
    validate_rate("factor * phi_dot", float(np.max(np.abs(given[1]), initial=0.0)) * factor)
    shape, (tops, tilts, phi_dots, psi_dots) = spread_tops(top, *given)
    angles, rules = bindings.compare_hurried(tops, tilts, phi_dots, psi_dots, factor, held)
    before, after = (np.sort([tilts, each], axis=0).reshape(2, *shape) for each in angles.T)
    rules = rules.reshape(shape)
    return HurryEffect(before, after, rules != RULES.index(None), rules == RULES.index("holds"))
