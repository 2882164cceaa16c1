"""The library: the same bits everywhere, alone and among others, and built for every program."""

import hashlib
import itertools

import numpy as np
import pytest
from physics.exact_motions import read_motions

from symtop_ros.physics import Motion, Motions, State, Top

# Of states at stored times; the same for x86 and ARM, and every version of NumPy.
STORED = read_motions()[:200]
BITS = "902cf70d3c4c"


# Times of all sizes and both signs, with the start and the first instants, as parts of one.
PARTS = [*np.linspace(-1, 3, 23).tolist(), 0.0, 1e-9, -1e-5, 1e-3, -0.3, 7.0]


def test_the_bits_are_those_of_every_other_machine():
    digest = hashlib.sha256()
    for each in STORED:
        states = each.motion.at(each.times)
        digest.update(states.orientation.tobytes() + states.angular_velocity.tobytes())
    assert digest.hexdigest()[:12] == BITS


@pytest.mark.parametrize("stored", STORED[::8], ids=[each.family for each in STORED[::8]])
def test_an_instant_has_the_same_bits_alone_and_among_others(stored):
    motion = stored.motion
    times = stored.times[0] * np.array(PARTS)
    together = motion.at(times)
    for n, t in enumerate(times):
        for one, other in zip(together[n]._parts, motion.at(float(t))._parts, strict=True):
            assert one.tobytes() == other.tobytes()


HALF_ROOT = float.fromhex("0x1.6a09e667f3bcdp-1")
ATTITUDES = (
    (0.5, 0.5, 0.5, 0.5),
    (HALF_ROOT, HALF_ROOT, 0, 0),
    (0.8, 0.6, 0, 0),
    (0, 0.6, 0.8, 0),
    (0.6, 0, 0.8, 0),
    (HALF_ROOT, 0, HALF_ROOT, 0),
    (0, 1, 0, 0),
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
    for part in motions.at(1.0)._parts:
        digest.update(part.tobytes())
    assert digest.hexdigest()[:12] == DIGEST


def test_a_component_that_rests_at_zero_is_exactly_zero():
    # phi' = psi', so (phi - psi)/2, of which y has the sine, stays zero
    start = State((HALF_ROOT, HALF_ROOT, 0, 0), (0, 1, 1))
    motion = Motion(Top(2, 1, 1), start)
    assert motion.kind == "regular"
    assert (motion.at([0.5, 1.0, 1e6]).orientation[:, 2] == 0).all()
