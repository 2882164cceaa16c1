"""Step 13 of the lesson as one follows its sheet: with the numbers of the top, and no motion."""

import math

import numpy as np

Ix, Iz, THETA, SPIN = 0.000228, 0.0000572, 0.5, 200.0
PUSH, PUSHES = 0.00005, 20  # N m s


def follow_by_hand(precession_rate):
    """Return p_psi and p_phi before, and of two rounds what is added to p_phi, and the tilt."""
    spin = Iz * (SPIN + precession_rate * math.cos(THETA))
    turn = Ix * precession_rate
    before = spin * math.cos(THETA) + turn * math.sin(THETA) ** 2
    rounds, taken = [], THETA
    for _ in range(2):
        added = PUSHES * PUSH * math.sin(taken)
        roots = np.roots([-turn, spin, turn - before - added])
        tilts = [math.acos(u) for u in roots if abs(u) <= 1]
        found = min(tilts, key=lambda tilt: abs(tilt - THETA))
        rounds.append((added, found))
        taken = (THETA + found) / 2
    return spin, before, rounds
