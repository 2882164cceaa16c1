"""Why a motion is set up with 50 digits (`PRECISE`), and the kernel's floats have 57.

A phase is a rate times the time, reduced to one turn and right to 2^-64 turns. So the error of a
rate is multiplied by the number of turns: after 1e15 of them (the kernel's limit) 16 digits leave
nothing, and 28 an error that adds up in a double. Each line has the largest error of a phase in
turns after so many turns, of motions near all singular cases; 0 is one below 2^-64.

50 digits serve 1e30 turns, where `Phases` refuses times. The kernel stores a step of a phase with
128 bits, which 50 digits and 57 both give: two limbs of 64 bits have 38 digits, too few, and three
have 57.
"""

from decimal import Decimal, localcontext

from symtop_ros.physics.exact.nutation import Nutation, find_roots
from symtop_ros.physics.exact.precise import PRECISE
from symtop_ros.physics.exact.quotients import compute_mean_rates, find_zeros

from symtop_ros.physics import State, Top

TRIED, ENOUGH = (16, 28, 38, 50, 57), 120
TURNS = (1e3, 1e9, 1e15, 1e29)
TOP = Top(0.000228, 0.0000572, 0.068)
STARTS = {
    "cusps": (TOP, State.from_euler(theta=0.5, psi_dot=200.0)),
    "a tilt of 1e-6": (TOP, State.from_euler(theta=1e-6, psi_dot=200.0)),
    "too slow to sleep": (TOP, State.from_euler(theta=1e-6, psi_dot=100.0)),
    "near the separatrix": (Top(1.0, 0.5, 0.5), State((0.5,) * 4, (-1.0 - 1e-7, 0.0, 0.0))),
    "nearly no weight": (Top(1.0, 1.0, 1e-9), State.from_euler(theta=1.0, psi_dot=2.0)),
}


def find_rates(top: Top, state: State, digits: int) -> list[Decimal]:
    """Return the nutation rate and the mean rates of arg A and arg B in rad/s."""
    q, omega = (tuple(part.tolist()) for part in state.parts)
    with localcontext(PRECISE) as context:
        context.prec = digits
        nutation = Nutation.of(top.moments, q, omega)
        roots = find_roots(nutation)
        k = (roots.s32 / roots.s31).sqrt()
        mean, (a, b, _) = compute_mean_rates(nutation, find_zeros(nutation, roots), k)
        return [(nutation.beta * roots.s31).sqrt() * mean, a, b]


def measure_loss(digits: int) -> float:
    """Return the largest error of a rate, as a part of the fastest one of its motion."""
    worst = Decimal(0)
    for start in STARTS.values():
        exact = find_rates(*start, ENOUGH)
        pairs = zip(find_rates(*start, digits), exact, strict=True)
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
