"""The article's top, and its motions by name."""

from __future__ import annotations

from dataclasses import dataclass

from symtop_ros.physics import Motion, State, Top, motion, regular_precession_rates
from symtop_ros.physics.perry import Direction

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
THETA, PSI_DOT = 0.5, 200.0  # rad, rad/s: of every start
PRINTED = ("6.50", "69.8")  # rad/s: the roots of regular precession as the article gives them
SLOW, FAST = regular_precession_rates(TOP, THETA, PSI_DOT)


@dataclass(frozen=True, slots=True)
class Rate:
    """One of the six precession rates that the article compares.

    Attributes
    ----------
    phi_dot : float
        At the start, in rad/s.
    place : str
        Where that is beside the two roots of regular precession.
    follows : {"rises", "falls", "stays"}
        What the article says of the top.
    """

    phi_dot: float
    place: str
    follows: Direction


RATES = (
    Rate(3.0, "below the slow root", "falls"),
    Rate(SLOW, "at the slow root", "stays"),
    Rate(9.0, "between the roots, near the slow one", "rises"),
    Rate(67.0, "between the roots, near the fast one", "rises"),
    Rate(FAST, "at the fast root", "stays"),
    Rate(73.0, "above the fast root", "falls"),
)

# A disc hanging from its pivot, spinning backwards: Iz > Ix, Mgl < 0, psi' < 0.
HANGING_DISC = Top(Ix=0.0002, Iz=0.00035, Mgl=-0.05)


@dataclass(frozen=True, slots=True)
class Hurried:
    """A case of Perry's rule.

    Attributes
    ----------
    psi_dot : float
        In rad/s.
    root : int
        Of regular precession: 0 for the slow one, 1 for the fast one.
    place : str
        Where that is.
    follows : {"rises", "falls"}
        What hurrying the precession from there does to the top.
    """

    psi_dot: float
    root: int
    place: str
    follows: Direction


FROM_SLOW = Hurried(PSI_DOT, 0, "at the slow root", "rises")
FROM_FAST = Hurried(PSI_DOT, 1, "at the fast root", "falls")
OF_THE_DISC = Hurried(
    -120.0, 0, "at the slow root for psi' < 0, Mgl < 0, Iz > Ix and theta < pi/2", "falls"
)


def start(phi_dot: float, psi_dot: float = PSI_DOT) -> State:
    """Return the start with theta = 0.5 rad, theta' = 0 and these rates (rad/s)."""
    return State.from_euler(theta=THETA, phi_dot=phi_dot, psi_dot=psi_dot)


def cusps(top: Top = TOP) -> Motion:
    """Return the motion whose axis is let go at rest."""
    return motion(top, start(0.0))


def regular(top: Top = TOP) -> Motion:
    """Return the motion that starts at the slow root, regular for the article's top."""
    return motion(top, start(SLOW))


def seven(top: Top = TOP) -> list[Motion]:
    """Return the motions of the six rates, and cusps."""
    return [*(motion(top, start(rate.phi_dot)) for rate in RATES), cusps(top)]
