"""Why a sum of mean rates must keep 20 digits, or is computed with more.

The mean precession and spin are a + b and a - b + c, with the means a and b of arg A and arg B. A
sphere that hardly feels its weight turns about L, and its mean spin is as small as the weight: the
terms cancel. Each line has the mean spin of such a sphere, from sums of that many digits. A double
has 17; the other three are for the rounding of the terms. Without the limit the last lines would be
rounding, or zero, where the true rate is in proportion to the weight.
"""

from symtop_ros.physics import State, Top
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm

WEIGHTS = (1e-3, 1e-12, 1e-24, 1e-30, 1e-36, 1e-48, 1e-60)  # J
START = State.from_euler(theta=1.0, theta_dot=0.3, phi_dot=2.0)


def find_mean_spins(Mgl: float) -> tuple[float, float]:
    """Return the mean spin in rad/s as 50 digits have it, and as 250 have it."""
    inputs = Inputs.of(Top(1.0, 1.0, Mgl), START)
    few, many = (ClosedForm(inputs, digits).mean_rates[1] for digits in (50, 250))
    return float(few), float(many)


def main() -> None:
    """Print the table."""
    print(f"{'Mgl (J)':10}{'50 digits':>24}{'250 digits':>24}")
    for Mgl in WEIGHTS:
        few, many = find_mean_spins(Mgl)
        print(f"{Mgl:<10.0e}{few:24.16e}{many:24.16e}")


if __name__ == "__main__":
    main()
