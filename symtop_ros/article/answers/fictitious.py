"""Claims on fictitious forces: the torques of the Coriolis and the centrifugal force.

They are summed over the four equal masses of Barker's model: a ring on the axis, above the pivot.
Its radius, height and mass follow from Ix, Iz and Mgl. Lengths are in m, forces in N.
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.article.claims import Claim
from symtop_ros.article.motions import (
    FAST,
    PSI_DOT,
    SLOW,
    THETA,
    cusps,
    measure_acceleration,
    start,
)
from symtop_ros.physics import Motion, State, Top

G = 9.81  # m/s^2; it decides the size of the ring, and none of the torques
RATES = (SLOW, 9.0, FAST, 73.0)  # rad/s
SUMMED = 1e-13  # of the largest torque; rounding of sums over four masses. Measured: 1e-15
DIFFERENTIATED = 1e-9  # of the largest torque; a difference is good to 1e-11
UP = np.array([0.0, 0.0, 1.0])
FORMULAS = (
    "Ix theta'' = Mgl sin(theta) - Iz phi' psi' sin(theta) + (Ix - Iz) phi'^2 sin(theta) cos(theta)"
)


@dataclass(frozen=True, slots=True)
class Forces:
    """Forces on the four masses, seen from a turning frame; all vectors in the world frame."""

    places: Real  # (4, 3) in m
    gravity: Real  # (4, 3) in N
    coriolis: Real  # (4, 3) in N
    centrifugal: Real  # (4, 3) in N

    def torques(self) -> Real:
        """Return the torques (3, 3) about the pivot in N m: gravity, Coriolis, centrifugal."""
        parts = self.gravity, self.coriolis, self.centrifugal
        return np.array([np.cross(self.places, part).sum(axis=0) for part in parts])


def four_masses(top: Top) -> tuple[float, Real]:
    """Return the mass in kg of each of the four, and their places (4, 3) in m in the body.

    4 m r^2 = Iz, 2 m r^2 + 4 m h^2 = Ix and 4 m g h = Mgl.
    """
    height = (top.Ix - top.Iz / 2) * G / top.Mgl
    mass = top.Mgl / (4 * G * height)
    radius = float(np.sqrt(top.Iz / (4 * mass)))
    ring = radius * np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])
    return mass, ring + height * UP


def forces_seen(top: Top, state: State, frame: Real) -> Forces:
    """Return the forces on the masses, seen from a frame that turns with (3,) rad/s."""
    mass, places = four_masses(top)
    places = np.array([state.to_world(place) for place in places])
    moving = np.cross(state.to_world(state.angular_velocity) - frame, places)
    return Forces(
        places,
        np.tile(-mass * G * UP, (4, 1)),
        -2 * mass * np.cross(frame, moving),
        -mass * np.cross(frame, np.cross(frame, places)),
    )


def torques_by_formula(top: Top, phi_dot: Real) -> Real:
    """Return gravity's, the Coriolis and the centrifugal torque (3, n) in N m about the nodes."""
    sine, cosine = np.sin(THETA), np.cos(THETA)
    return np.array(
        [
            np.full_like(phi_dot, top.Mgl * sine),
            -top.Iz * phi_dot * PSI_DOT * sine,
            (top.Ix - top.Iz) * phi_dot**2 * sine * cosine,
        ]
    )


def claims_on_fictitious_forces(top: Top) -> list[Claim]:
    """Return the claims on the torques in the precessing frame and in the body's."""
    return [
        *(torques_decide(top, rate) for rate in RATES),
        torques_explain_perrys_rule(top),
        body_frame_has_no_coriolis(cusps(top)),
    ]


def torques_decide(top: Top, phi_dot: float) -> Claim:
    """Check that the three torques, summed over masses, are the formulas and Ix theta''."""
    state = start(phi_dot)
    summed = forces_seen(top, state, phi_dot * UP).torques()[:, 0]  # phi = 0: the nodes are x'
    formula = torques_by_formula(top, np.array([phi_dot]))[:, 0]
    size = float(np.abs(formula).max())
    off = float(np.abs(summed - formula).max()) / size
    moved = top.Ix * measure_acceleration(Motion(top, state))
    missed = abs(float(summed.sum()) - moved) / size
    words = zip(("gravity", "Coriolis", "centrifugal"), summed, strict=True)
    numbers = ", ".join(f"{word} {value:+.5f}" for word, value in words)
    return Claim(
        "In the frame that precesses with the top, gravity's, the Coriolis and the centrifugal "
        f"torque together turn the axis (phi' = {phi_dot:.5g} rad/s).",
        f"about the line of nodes, in N m: {numbers}, sum {summed.sum():+.5f}; summed over four "
        f"masses they are off the formulas by {off:.0e}, and off Ix theta'' of the motion by "
        f"{missed:.0e}",
        off < SUMMED and missed < DIFFERENTIATED,
        FORMULAS,
        f"{SUMMED:g}: rounding of sums over masses; {DIFFERENTIATED:g} for theta'' by differences",
    )


def torques_explain_perrys_rule(top: Top) -> Claim:
    """Check the powers of phi' of both torques, and which of them wins at each root."""
    rates = np.array([SLOW, 2 * SLOW, FAST, 2 * FAST])
    summed = np.array(
        [forces_seen(top, start(rate), rate * UP).torques()[:, 0] for rate in rates.tolist()]
    )
    coriolis, centrifugal = summed[:, 1], summed[:, 2]
    powers = [float(np.log2(part[1] / part[0])) for part in (coriolis, centrifugal)]
    off = max(abs(powers[0] - 1), abs(powers[1] - 2))
    growth = [float(coriolis[k] + 2 * centrifugal[k]) for k in (0, 2)]
    return Claim(
        "Perry's rule in one line: the Coriolis torque lifts the axis and grows with phi', the "
        "centrifugal torque lowers it and grows with the square; the first wins at the slow root, "
        "the second at the fast one.",
        f"phi' doubled: powers {powers[0]:.4f} and {powers[1]:.4f}; phi' times the change of their "
        f"sum with phi': {growth[0]:+.4f} N m at the slow root, {growth[1]:+.4f} N m at the fast "
        "one",
        bool(
            (coriolis < 0).all()
            and (centrifugal > 0).all()
            and off < SUMMED
            and growth[0] < 0 < growth[1]
        ),
        FORMULAS,
        f"{SUMMED:g}: rounding of sums over masses, in the powers",
    )


def body_frame_has_no_coriolis(motion: Motion) -> Claim:
    """Check that in the body's frame only the centrifugal force is left, with -omega x L."""
    state = motion.at(motion.nutation_period / 4)
    frame = state.to_world(state.angular_velocity)
    forces = forces_seen(motion.top, state, frame)
    centrifugal = forces.torques()[2]
    expected = -np.cross(frame, motion.top.angular_momentum(state))
    size = float(np.abs(expected).max())
    off = float(np.abs(centrifugal - expected).max()) / size
    coriolis = float(np.abs(forces.coriolis).max())
    return Claim(
        "In the body's frame there is no Coriolis force, because nothing moves there, and the "
        "torque of the centrifugal force is the inertial torque -omega x L.",
        f"Coriolis force at most {coriolis:g} N; the centrifugal torque, up to {size:.4f} N m, is "
        f"off by {off:.0e} (cusps, after a quarter of a nutation)",
        coriolis == 0 and off < SUMMED,
        "sum of -m r x (omega x (omega x r)) = -omega x L",
        f"{SUMMED:g}: rounding of sums over masses",
    )
