"""The effect of friction at the spin on the precession, as a record."""

import math
from dataclasses import dataclass
from typing import Literal

from symtop_ros.physics import ExactTimes, Motion
from symtop_ros.run.wire.layout import NANOSECONDS

# What is integrated for a sentence, in turns and decays of 1 rad: some 10 ms.
LONGEST = 2e4
TELLING = 1.05  # ratio of the rates; a smaller one is no change that is seen


@dataclass(frozen=True, slots=True)
class Decay:
    """The precession at first, and when friction has taken half of the spin momentum.

    The friction at the spin is the only force with a moment along the axle: p_psi decays as
    exp(-axial t/Iz), whatever the tilt does.
    """

    kind: Literal["faster", "slower"]
    seconds: float
    before: float  # mean phi' in rad/s, under gravity alone from the state at first
    after: float  # from the state then

    @classmethod
    def of(cls, motion: Motion) -> "Decay | None":
        """Return it for a motion on which friction and gravity act.

        It is None without friction at the spin, if integration takes long, and if the mean phi' is
        undefined at a time, has changed its sign, or is nearly the same.
        """
        axial, transverse = motion.friction.axial, motion.friction.transverse
        if not axial or any(motion.applied_torque) or motion.pushes or motion.clamped:
            return None
        seconds = motion.top.Iz * math.log(2) / axial
        rate = max(map(abs, motion.start.angular_velocity.tolist())) + transverse / motion.top.Ix
        if not rate * seconds <= LONGEST:
            return None
        then = motion.at(ExactTimes(math.floor(seconds * NANOSECONDS)))
        before, after = (
            Motion(motion.top, state).mean_precession_rate for state in (motion.start, then)
        )
        low, high = sorted((abs(before), abs(after)))
        if not (before * after > 0 and high > TELLING * low):
            return None
        return cls("faster" if abs(after) > abs(before) else "slower", seconds, before, after)
