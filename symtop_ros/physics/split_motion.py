"""The motion under friction or an applied torque: no closed form, integrated as far as is asked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.friction import Friction
from symtop_ros.physics.splitting import Point, Splitting, Three
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.trail import Trail

Real = NDArray[np.float64]


class SplitMotion:
    """States by `splitting`, on a grid that goes both ways from the start.

    Parameters
    ----------
    top : Top
    start : State
        At t = 0.
    friction : Friction
    torque : (3,) of float
        Applied torque in the world frame, N m.
    """

    def __init__(self, top: Top, start: State, friction: Friction, torque: Three) -> None:
        w, x, y, z = start.orientation.tolist()
        wx, wy, wz = start.angular_velocity.tolist()
        point = Point(0.0, complex(w, z), complex(x, y), complex(wx, wy), wz)
        splitting = Splitting(top, friction, torque)
        self._forth, self._back = (Trail(splitting, point, direction) for direction in (1, -1))

    def fill(self, times: Real, orientation: Real, angular_velocity: Real) -> None:
        """Write the states at times (n,) in s into arrays (n, 4) and (n, 3)."""
        for k in np.argsort(times, kind="stable").tolist():
            t = float(times[k])
            point = self._trail(t).at(t)
            A, B = point.attitude
            orientation[k] = A.real, B.real, B.imag, A.imag
            angular_velocity[k] = point.rates

    def reach(self, t: float, most: float) -> float:
        """Integrate towards t, in so many steps at most; return the time that was reached."""
        return self._trail(t).reach(t, most)

    def _trail(self, t: float) -> Trail:
        return self._forth if t >= 0 else self._back
