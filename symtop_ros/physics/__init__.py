"""The heavy symmetric top: exact motion, constants, regular precession, kicks and Perry's rule.

It needs NumPy only. Everything may import it, by the names that are exported here. The numbers are
computed by a kernel in C++ (`kernel`). Angles are Euler's z-x-z (phi, theta, psi), units are SI and
rad, an orientation is a unit quaternion (w, x, y, z) from body to world.

Examples
--------
>>> from symtop_ros.physics import Motion, State, Top
>>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
>>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
>>> motion.kind
'cusps'
"""

from symtop_ros.base.deprecation import warn_of_name
from symtop_ros.physics.body import Body
from symtop_ros.physics.certificate import Certificate
from symtop_ros.physics.dynamics import (
    DEFAULT_GRAVITY,
    Balance,
    angular_acceleration,
    balance,
    point_acceleration,
    specific_force,
)
from symtop_ros.physics.gimbal import GimbalShares, gimbal_shares
from symtop_ros.physics.kernel.bindings import kernel_version
from symtop_ros.physics.kernel.records import QUESTIONS, Direction, Hold, Kind
from symtop_ros.physics.kicks import (
    HOLDS,
    apply_impulse,
    hurry,
    precession_rate,
    push_axle,
    set_precession_rate,
    validate_hold,
)
from symtop_ros.physics.ledger import Contribution, Energies, Exchange, Ledger
from symtop_ros.physics.motion import Motion, Piece, find_period
from symtop_ros.physics.motions import Motions
from symtop_ros.physics.parts import BODIES, SIZES, Part
from symtop_ros.physics.potential import EffectivePotential
from symtop_ros.physics.precession import (
    FrameTorques,
    precessing_frame_torques,
    regular_precession_rates,
    theta_acceleration,
    theta_torque,
)
from symtop_ros.physics.pushes import MOST_PUSHES, PUSH_RATES, Pushes
from symtop_ros.physics.rule.cause import Cause
from symtop_ros.physics.rule.clamp import ClampVerdict, clamp_verdict
from symtop_ros.physics.rule.means import MeanChange
from symtop_ros.physics.rule.perry import KickVerdict, Lift, kick_verdict
from symtop_ros.physics.rule.perry_map import HurryEffect, compare_hurried
from symtop_ros.physics.rule.verdict import Verdict, Verdicts, perrys_rule
from symtop_ros.physics.starts import Solution, solve_start
from symtop_ros.physics.state import Angles, Rates, State
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction, Top

__all__ = [
    "BODIES",
    "DEFAULT_GRAVITY",
    "HOLDS",
    "MOST_PUSHES",
    "PUSH_RATES",
    "QUESTIONS",
    "SIZES",
    "Angles",
    "Balance",
    "Body",
    "Cause",
    "Certificate",
    "ClampVerdict",
    "Contribution",
    "Direction",
    "EffectivePotential",
    "Energies",
    "ExactTimes",
    "Exchange",
    "FrameTorques",
    "Friction",
    "GimbalShares",
    "Hold",
    "HurryEffect",
    "KickVerdict",
    "Kind",
    "Ledger",
    "Lift",
    "MeanChange",
    "Motion",
    "Motions",
    "Part",
    "Piece",
    "Pushes",
    "Rates",
    "Solution",
    "State",
    "Top",
    "Verdict",
    "Verdicts",
    "angular_acceleration",
    "apply_impulse",
    "balance",
    "clamp_verdict",
    "compare_hurried",
    "find_period",
    "gimbal_shares",
    "hurry",
    "kernel_version",
    "kick_verdict",
    "perrys_rule",
    "point_acceleration",
    "precessing_frame_torques",
    "precession_rate",
    "push_axle",
    "regular_precession_rates",
    "set_precession_rate",
    "solve_start",
    "specific_force",
    "theta_acceleration",
    "theta_torque",
    "validate_hold",
]


def __getattr__(name: str) -> float:
    """Return what an old name stands for."""
    if name == "STANDARD_GRAVITY":  # until 0.8
        return warn_of_name(name, "DEFAULT_GRAVITY", DEFAULT_GRAVITY)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
