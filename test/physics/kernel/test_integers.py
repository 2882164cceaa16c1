"""Starts of small integers: sums that are exactly zero are found as zero."""

import hashlib
import itertools

import numpy as np

from symtop_ros.physics import Motion, Motions, State, Top

HALF_ROOT = float.fromhex("0x1.6a09e667f3bcdp-1")
ATTITUDES = (
    *((0.5, 0.5, 0.5, 0.5), (HALF_ROOT, HALF_ROOT, 0, 0), (0.8, 0.6, 0, 0), (0, 0.6, 0.8, 0)),
    *((0.6, 0, 0.8, 0), (HALF_ROOT, 0, HALF_ROOT, 0), (0, 1, 0, 0)),
)
RATES = list(itertools.product((-1, 0, 1, 2), repeat=3))
TOPS = [
    moments for moments in itertools.product((1, 2, 3), (1, 2, 3, 4), (-1, 1, 2))
    if moments[1] <= 2 * moments[0]
]  # fmt: skip
# Of their kinds and states, as two independent programs computed them.
DIGEST = "be166d62ffd8"


def test_small_integers_have_the_bits_that_python_and_the_kernel_had():
    rows = list(itertools.product(TOPS, ATTITUDES, RATES))
    moments, attitudes, rates = (np.array(column, float) for column in zip(*rows, strict=True))
    motions = Motions(Top(*moments.T), State(attitudes, rates))
    digest = hashlib.sha256("".join(motions.kind).encode())
    for part in motions.at(1.0).parts:
        digest.update(part.tobytes())
    assert digest.hexdigest()[:12] == DIGEST


def test_a_component_that_rests_at_zero_is_exactly_zero():
    # phi' = psi', so (phi - psi)/2, of which y has the sine, stays zero
    start = State((HALF_ROOT, HALF_ROOT, 0, 0), (0, 1, 1))
    motion = Motion(Top(2, 1, 1), start)
    assert motion.kind == "regular"
    assert (motion.at([0.5, 1.0, 1e6]).orientation[:, 2] == 0).all()
