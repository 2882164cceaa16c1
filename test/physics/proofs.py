"""Proved errors of the kernel's states in random motions.

    PYTHONPATH=.:test python -m physics.proofs [COUNT]

proves the errors of COUNT motions of each family, 5000 if it is not given, and prints the largest,
in parts of what docs/accuracy.md promises.
"""

import sys
from collections.abc import Sequence
from multiprocessing import Pool

from flint import arb, ctx
from physics.families import DRAWS, draw_motion

from symtop_ros.physics import Motion
from symtop_ros.physics.reference.proved import bound_errors, prove_state
from symtop_ros.physics.reference.series import Inputs

EPS = arb(2) ** -52
COUNT = 5000  # of each family: 100 000 in all
ATTITUDE, RATES = 20, 10  # eps that docs/accuracy.md promises


def find_errors(motion: Motion, t: float) -> tuple[arb, arb]:
    """Return the errors at a time as balls, in eps: of the attitude, and of the rates by size."""
    exact = prove_state(Inputs.of(motion.top, motion.start), t)
    found = motion.at(t)
    q, omega = found.orientation.tolist(), found.angular_velocity.tolist()
    with ctx.workprec(256):
        attitude, rates = bound_errors(exact, q, omega)
        # an axis that rests has no size: its rates are exact, or infinitely wrong
        relative = rates if rates.is_zero() else rates / exact.size
        return attitude / EPS, relative / EPS


def find_largest_errors(family: str, count: int) -> tuple[float, float]:
    """Return bounds of the largest errors of the first motions of a family, in eps."""
    errors = [find_errors(*draw_motion(family, number)) for number in range(count)]
    assert all(ball.is_finite() for pair in errors for ball in pair)  # max() drops a nan
    attitude, rates = zip(*errors, strict=True)
    return tuple(max(float(each.upper()) for each in column) for column in (attitude, rates))


def main(words: Sequence[str]) -> None:
    count = int(words[0]) if words else COUNT
    largest = [0.0, 0.0]
    with Pool() as pool:
        for family, found in zip(
            DRAWS, pool.imap(_measure, [(f, count) for f in DRAWS]), strict=True
        ):
            print(f"{family:20} {found[0]:6.2f} {found[1]:6.2f} eps", flush=True)
            largest = [max(pair) for pair in zip(largest, found, strict=True)]
    print(f"{count * len(DRAWS)} motions: {largest[0]:.2f} and {largest[1]:.2f} eps")


def _measure(task: tuple[str, int]) -> tuple[float, float]:
    return find_largest_errors(*task)


if __name__ == "__main__":
    main(sys.argv[1:])
