"""Why a motion is set up with 57 digits, which are three limbs of 64 bits (`Precise`).

A phase is a rate times the time, reduced to one turn and right to 2^-64 turns. So the error of a
rate is multiplied by the number of turns: after 1e15 of them (the kernel's limit) 16 digits leave
nothing, and 28 an error that adds up in a double. Sums of n digits are off as if the weight
changed by a part of 10^-n. Next to the separatrix this is far from harmless: doubles miss it by
1e-17, and as many digits are lost. Each line has the largest error of a phase in turns after so
many turns, of motions near all singular cases; 0 is one below 2^-64. Two limbs have 38 digits, too
few.
"""

import math
from fractions import Fraction

from mpmath import mp, mpf

from symtop_ros.physics import State, Top
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm

TRIED = (16, 28, 38, 50, 57)
ENOUGH = 120
TURNS = (1e3, 1e9, 1e15)
TOP = Top(0.000228, 0.0000572, 0.068)
RISING = State.from_euler(theta=math.pi / 2, theta_dot=-math.sqrt(2))
STARTS = {
    "cusps": (TOP, State.from_euler(theta=0.5, psi_dot=200.0)),
    "a tilt of 1e-6": (TOP, State.from_euler(theta=1e-6, psi_dot=200.0)),
    "too slow to sleep": (TOP, State.from_euler(theta=1e-6, psi_dot=100.0)),
    "near the separatrix": (Top(1.0, 0.5, 1.0), RISING),
    "nearly no weight": (Top(1.0, 1.0, 1e-9), State.from_euler(theta=1.0, psi_dot=2.0)),
}


def find_rates(inputs: Inputs) -> list[mpf]:
    """Return the exact rates of the nutation, of phi and of psi in rad/s."""
    motion = ClosedForm(inputs, ENOUGH)
    return [2 * mp.pi / motion.period, *motion.mean_rates]


def measure_loss(digits: int) -> float:
    """Return the largest error of a rate, as a part of the fastest one of its motion."""
    worst = mpf(0)
    with mp.workdps(ENOUGH):
        for top, start in STARTS.values():
            inputs = Inputs.of(top, start)
            rounded = inputs._replace(Mgl=inputs.Mgl * (1 + Fraction(1, 10**digits)))
            exact = find_rates(inputs)
            pairs = zip(find_rates(rounded), exact, strict=True)
            worst = max(worst, *(abs(found - rate) / max(map(abs, exact)) for found, rate in pairs))
    return float(worst)


def main() -> None:
    """Print the table."""
    print(f"{'digits':8}" + "".join(f"{turns:8.0e}" for turns in TURNS) + "  turns")
    for digits in TRIED:
        errors = [min(measure_loss(digits) * turns, 1.0) for turns in TURNS]
        print(f"{digits:<8}" + "".join(f"{each if each > 2**-64 else 0:8.0e}" for each in errors))


if __name__ == "__main__":
    main()
