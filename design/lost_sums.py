"""Why a sum of mean rates must keep 20 digits (`KEPT`), or is computed with more.

The mean precession and spin are a + b and a - b + c, with the means a and b of arg A and arg B. A
sphere that hardly feels its weight turns about L, and its mean spin is as small as the weight: the
terms cancel. Each line has the mean spin of such a sphere, from sums of that many digits. A double
has 17; the other three are for the rounding of the terms. Without the limit the last lines would be
rounding, or zero, where the true rate is in proportion to the weight.
"""

from decimal import Decimal, localcontext

from symtop_ros.physics.exact.mean_rates import KEPT, add_means
from symtop_ros.physics.exact.precise import PRECISE

from design.digits import find_rates
from symtop_ros.physics import State, Top

WEIGHTS = (1e-3, 1e-12, 1e-24, 1e-30, 1e-36, 1e-48, 1e-60)  # J
START = State.from_euler(theta=1.0, theta_dot=0.3, phi_dot=2.0)


def find_mean_spins(Mgl: float) -> tuple[float, float]:
    """Return the mean spin in rad/s as the sum of 50 digits has it, and as `add_means` has it."""
    top = Top(1.0, 1.0, Mgl)
    q, omega = (tuple(part.tolist()) for part in START.parts)
    _, a, b = find_rates(top, START, PRECISE.prec)
    with localcontext(PRECISE):
        kept = add_means(a, b, Decimal(0), top.moments, q, omega)
        return float(a - b), float(kept[1])


def main() -> None:
    """Print the table."""
    print(f"a sum keeps {KEPT} digits\n{'Mgl (J)':10}{'50 digits':>24}{'as many as needed':>24}")
    for Mgl in WEIGHTS:
        plain, kept = find_mean_spins(Mgl)
        print(f"{Mgl:<10.0e}{plain:24.16e}{kept:24.16e}")


if __name__ == "__main__":
    main()
