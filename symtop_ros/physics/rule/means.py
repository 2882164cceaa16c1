"""Means of a motion with a kick and without it: sense of the kick, and mean height.

Perry's rule is a statement on theta'' at one instant (`perry.py`). In the backward part of a loop
the precession of that instant has the sign opposite to the one that is seen. The means compare a
kick with the whole motion: is it along the mean precession or against it, and does the mean of
cos(theta) grow? docs/article.md, "In the mean", defines both and says where they differ. The
formulas are in the kernel (`kernel/rule/means.hpp`).
"""

import math
from dataclasses import dataclass

from symtop_ros.physics.kernel.records import (
    LIFT_KINDS,
    SENSES,
    LiftKind,
    MeansRecord,
    Sense,
    Subject,
)


@dataclass(frozen=True, slots=True)
class MeanChange:
    """Means of a motion with a kick, compared with no kick.

    Attributes
    ----------
    sense : {"along", "against"} or None
        "along": the kick changes phi' in the direction of the mean precession; "against": in the
        opposite one. None if phi' does not change; for an angular impulse that is not a push along
        the precession or against it; for Mgl = 0; and if a mean phi' is undefined, zero within its
        rounding, or of the other sign with the kick.
    height : {"higher", "lower", "unchanged"}
        Change of the mean height of the axis. For Mgl < 0 the centre of mass moves the other way.
    rates : (float, float) or None
        Mean phi' in rad/s without the kick and with it; None if one is undefined.
    cosines : (float, float)
        Mean of cos(theta) without the kick and with it.
    subject : {"top", "axis"}
        "axis" for Mgl < 0.

    Examples
    --------
    In the backward part of a loop a delay is a push along the mean precession:

    >>> from symtop_ros.physics import State, Top, perrys_rule
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> at_the_top_of_a_loop = State.from_euler(theta=0.5, phi_dot=-20.0, psi_dot=200.0)
    >>> verdict = perrys_rule(top, at_the_top_of_a_loop, factor=0.5, hold="spin_momentum")
    >>> means = verdict.means
    >>> verdict.rule_holds, means and means.sense, means and means.height
    (False, 'along', 'higher')
    """

    sense: Sense | None
    height: LiftKind
    rates: tuple[float, float] | None
    cosines: tuple[float, float]
    subject: Subject


def read_means(found: MeansRecord, subject: Subject) -> MeanChange | None:
    """Return the means from the kernel's record of a verdict; None if they are undefined."""
    was, now = found.cosines
    if math.isnan(was):
        return None
    before, after = found.rates
    return MeanChange(
        SENSES[found.sense],
        LIFT_KINDS[found.height],
        None if math.isnan(before + after) else (before, after),
        (was, now),
        subject,
    )
