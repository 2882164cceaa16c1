"""The theta quotients as functions of the nutation phase: choice of the series that converges fast.

Each of A, B and conj(omega_xy) is th_k(v + i shift)/th4(v) times a constant and an exponential,
with k = 4 for A and k = 3 for the other two. th_k(v) = theta_k(pi v/(2 K) | q) are Jacobi's theta
functions (DLMF 20.2). The series in the nome q = exp(-pi K'/K) converge fast for m <= 1/2 and
ever more slowly towards the separatrix m = 1. For m > 1/2 they are summed after Jacobi's imaginary
transformation (DLMF 20.7.30 to 20.7.33) in the nome q' = exp(-pi K/K'). With the better of the two
no nome exceeds exp(-pi) = 0.043, and the first term left out is below 1e-16 of the sum
(design/nomes.py).

`scipy.special.ellipj` would not do: for m near 1 and for large arguments it loses all digits (SciPy
issue 8480).
"""

from collections.abc import Sequence
from typing import TypeAlias

from symtop_ros.physics.exact.complementary_series import ComplementarySeries
from symtop_ros.physics.exact.direct_series import DirectSeries
from symtop_ros.physics.exact.elementary import Shift

Series: TypeAlias = DirectSeries | ComplementarySeries


def choose_series(K: float, Kc: float, root_of_nome: float, shifts: Sequence[Shift]) -> Series:
    """Return the series in the smaller nome.

    `root_of_nome` is exp(-pi K/(2 K')), right to rounding however large K/K' is.
    """
    if Kc >= K:
        return DirectSeries(K, Kc, shifts)
    return ComplementarySeries(K, Kc, shifts, root_of_nome)
