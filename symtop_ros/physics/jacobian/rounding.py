"""The rounding of a motion's states, as their differences show it."""

import numpy as np

from symtop_ros.base.arrays import Places, Real
from symtop_ros.physics.jacobian.differentiable import Differentiable
from symtop_ros.physics.jacobian.scales import find_widths
from symtop_ros.physics.state import State
from symtop_ros.physics.values import EPS

# Rounding of a state in a difference. Its standard deviation is 0.5 to 0.8 EPS.
STATE_ERROR = 3 * EPS
# It may also be this much of what is left in the tenth differences, of the fourth smallest of nine
# parameters: next to an unstable place five are smooth.
REMAINDERS, SMOOTH = 4, 4
# All states of a driven motion have an error of its steps, which no difference shows: after an
# unstable place it is some ten times as large.
DRIVEN_REMAINDERS = 48
ACROSS = np.array((1, 1, 0))[:, None]  # components across the axis, (3, 1)


class Rounding:
    """Estimates of the rounding of states (n,) in their attitude and omega."""

    def __init__(self, motion: Differentiable, states: State, of_states: Real) -> None:
        """Begin with the sizes of states, (n, 2, 1)."""
        self._least, self._most = _find_bounds(motion, states, of_states)
        self._remainders = DRIVEN_REMAINDERS if motion.is_driven else REMAINDERS
        self._left = np.full((len(of_states), 2, 3, 9), np.inf)

    def find(self, left: Real, widths: Real, some: Places, columns: Places) -> Real:
        """Return the rounding of some states (m, 2, 3, c).

        `left` is what tenth differences by the columns have left of them, and `widths` is how far
        the states moved. The rounding is the same for all parameters, and most of them are smooth
        by the first steps.
        """
        part = np.ix_(some, np.arange(2), np.arange(3), columns)
        self._left[part] = np.minimum(self._left[part], left)
        smooth = np.sort(self._left[some], axis=-1)[..., SMOOTH - 1 : SMOOTH]
        bounds = (
            STATE_ERROR * (each[some] + ACROSS * widths) for each in (self._least, self._most)
        )
        return np.asarray(np.clip(self._remainders * smooth, *bounds))


def _find_bounds(motion: Differentiable, states: State, of_states: Real) -> tuple[Real, Real]:
    """Return the least and the largest sizes of what is rounded, (n, 2, 3, 1).

    Next to the vertical the components across the axis are small, and have the relative precision
    of their size, at the time or at least where they are largest. A driven motion may amplify the
    rounding of its steps.
    """
    least = np.repeat(of_states[:, :, None], 3, axis=2)
    w, x, y, z = np.moveaxis(states.orientation, -1, 0)
    least[:, 0, :2, 0] = (2 * np.hypot(w, z) * np.hypot(x, y))[:, None]
    least[:, 1, :2, 0] = np.hypot(*states.angular_velocity[:, :2].T)[:, None]
    if motion.is_driven:
        return least, np.full_like(least, np.inf)
    most = np.repeat(of_states[:, :, None], 3, axis=2)
    most[:, :, :2] = np.array(find_widths(motion))[:, None, None]
    least[:, 1, 2] = most[:, 1, 2] = 0  # omega_z is that of the start
    return least, np.maximum(most, least)
