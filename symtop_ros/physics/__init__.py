"""The heavy symmetric top: exact motion, constants, regular precession, kicks and Perry's rule.

Needs NumPy and SciPy only. Angles are Euler's z-x-z (phi, theta, psi), units are SI and rad, an
orientation is a unit quaternion (w, x, y, z) from body to world.
"""

from symtop_ros.physics.balance import Balance, balance
from symtop_ros.physics.friction import Friction
from symtop_ros.physics.kicks import hurry, impulse, push, set_precession_rate
from symtop_ros.physics.motion import Motion, motion
from symtop_ros.physics.perry import Verdict, perry
from symtop_ros.physics.precession import regular_precession_rates
from symtop_ros.physics.state import Angles, State
from symtop_ros.physics.top import Top

__all__ = [
    "Angles",
    "Balance",
    "Friction",
    "Motion",
    "State",
    "Top",
    "Verdict",
    "balance",
    "hurry",
    "impulse",
    "motion",
    "perry",
    "push",
    "regular_precession_rates",
    "set_precession_rate",
]
