"""The place in the nutation: the phase since a turning point, and the distances from both."""

import math
from decimal import Decimal
from functools import cached_property

from symtop_ros.physics.exact.elementary import (
    Location,
    Number,
    Pair,
    choose_smaller,
    exponential,
    find_rest,
    find_sign,
    find_size,
    integrate_rf_in_doubles,
    round_to_integer,
)
from symtop_ros.physics.exact.nutation import Nutation, Roots
from symtop_ros.physics.exact.precise import (
    HALF,
    ONE,
    PI_HIGH,
    PI_LOW,
    TWO,
    TWO_PI,
    ZERO,
    integrate_rf,
    split,
    split_short,
)
from symtop_ros.physics.exact.quotients import Zeros, compute_mean
from symtop_ros.physics.times import ExactTimes

# From this ratio K/K' on phases are computed with all digits: they are then stretched.
STRETCHED = 1.5
# From this share of |A|^2 or |B|^2 at the far turning point left at the near one, the rounding of a
# phase counts: theta changes fast compared with itself.
NEAR_POLE = Decimal("0.01")
# On the separatrix y grows for ever. Here exp(-y/2) is zero, and the axis is upright to any digit.
FARTHEST = 1e6


class NutationPhase:
    """The phase x = pi v/K as a function of time, with v = v0 + Omega t.

    `mean` is the arithmetic-geometric mean of 1 and sqrt(1 - m), and 0 at the separatrix: there K
    is infinite, and y = x K/K' takes the place of x.
    """

    def __init__(
        self, nutation: Nutation, roots: Roots, zeros: Zeros, mean: Decimal, frequency: Decimal
    ) -> None:
        self._nutation, self._roots, self._zeros, self._mean = nutation, roots, zeros, mean
        self.Omega = float(frequency) / 2
        self.K = math.pi / (2 * float(mean)) if mean else math.inf
        self.Kc = quarter_period(float((roots.s21 / roots.s31).sqrt()))
        # True near the separatrix, if K/K' is so large that the rounding of phases matters.
        self._is_stretched = STRETCHED * self.Kc < self.K

    def locate(self, t: Number | ExactTimes, high: Number, low: Number) -> Location:
        """Return the location at a time, from the phase since t = 0 as the sum of two doubles.

        The phase is kept as two doubles until its distance from the nearer turning point is known.
        Near the separatrix this distance is stretched by K/K', and so would be its rounding.
        """
        from_top, (origin, rest) = self._origin
        if not self._mean:  # no period: y = x K/K' grows for ever, while x stays 0
            seconds = t.seconds if isinstance(t, ExactTimes) else t
            longest = FARTHEST / self.Omega
            seconds = choose_smaller(seconds, longest, seconds, longest)
            seconds = choose_smaller(seconds, -longest, -longest, seconds)
            y = origin + 2 * self.Omega * seconds
            return Location(0.0 * y, y, math.inf + 0.0 * y)
        total = high + origin
        part = total - high
        error = (high - (total - part)) + (origin - part) + (low + rest)  # Knuth's two-sum
        # 2 pi is subtracted exactly: the numbers are within a factor 2 of each other.
        turns = round_to_integer(total / (2 * math.pi))
        total = total - turns * (2 * PI_HIGH)
        error = error - turns * (2 * PI_LOW)
        sign, size = find_sign(total), find_size(total)
        near = size, sign * error
        far = PI_HIGH - size, PI_LOW - near[1]  # the first difference is exact if it is the nearer
        below, above = (far, near) if from_top else (near, far)
        x = (below[0] + below[1]) * (-sign if from_top else sign)
        if self.Kc >= self.K:  # the direct series is not stretched
            return Location(x, x, above[0] + above[1])
        return self._stretch(x, below, above)

    def _stretch(self, x: Number, below: Pair, above: Pair) -> Location:
        """Return the location for the complementary series, from |x| and pi - |x| as two doubles.

        A quotient is as small as exp(-y/2) of itself elsewhere, y being the smaller one of the two
        distances times K/K'. The rounding of y, half an ulp of up to pi/2 K/K', would be the
        largest error of a small tilt.
        """
        ratio, parts = self._ratio
        y, rise = x * ratio, (above[0] + above[1]) * ratio
        if not self._is_stretched:
            return Location(x, y, rise)
        size = find_size(y)
        high = choose_smaller(rise, size, above[0], -below[0])
        low = choose_smaller(rise, size, above[1], -below[1])
        return Location(x, y, rise, find_rest((high, low), parts, (high + low) * ratio))

    @cached_property
    def start(self) -> Location:
        """The location at t = 0."""
        return Location(*map(float, self.locate(0.0, 0.0, 0.0)))

    @property
    def lower_turning_point(self) -> Location:
        """The location at which theta is largest."""
        return Location(0.0, 0.0, math.pi * max(1.0, self.K / self.Kc))

    @property
    def upper_turning_point(self) -> Location:
        """The location at which theta is smallest."""
        return Location(math.pi, math.pi * max(1.0, self.K / self.Kc), 0.0)

    @property
    def shortest_change(self) -> float:
        """Time in s in which the functions of the motion change where they change fastest."""
        return 0.5 / math.pi * min(self.K, self.Kc) / self.Omega

    @cached_property
    def root_of_nome(self) -> float:
        """exp(-pi K/(2 K')), right to rounding: of a double, pi K/(2 K') would be rounded."""
        if not self._exact_ratio:
            return float(exponential(-math.pi / 2 * self.K / self.Kc))
        return float((-HALF * TWO_PI * HALF * self._exact_ratio).exp())

    @cached_property
    def _ratio(self) -> tuple[float, tuple[float, float]]:
        """K/K', and the same in two parts for `find_rest`, of which the first one is short."""
        exact = self._exact_ratio
        return (float(exact), split_short(exact)) if exact else (self.K / self.Kc, (0.0, 0.0))

    @cached_property
    def _exact_ratio(self) -> Decimal:
        """K/K' with all digits if phases are stretched, and 0 elsewhere."""
        if not (self._is_stretched and self._mean):
            return ZERO
        return compute_mean((self._roots.s21 / self._roots.s31).sqrt()) / self._mean

    @cached_property
    def _origin(self) -> tuple[bool, tuple[float, float]]:
        """The nearer turning point at t = 0 (True: the upper one), and the phase from there."""
        precise = self._is_stretched or self._comes_near_a_pole
        from_top, v = _starting_phase(self._nutation, self._roots, precise)
        return from_top, split(TWO * (self._mean or ONE) * v)  # pi v/K, or 2 v for K' = pi/2

    @property
    def _comes_near_a_pole(self) -> bool:
        """True if the axis passes so near a pole that the rounding of phases matters."""
        lower, upper = self._zeros.A, self._zeros.B
        return (
            lower.from_u1 < NEAR_POLE * lower.from_u2 or upper.from_u2 < NEAR_POLE * upper.from_u1
        )


def quarter_period(modulus: float) -> float:
    """Return the complete elliptic integral K from the complementary modulus sqrt(1 - m).

    K = pi/2 divided by the arithmetic-geometric mean of 1 and the complementary modulus (DLMF
    19.8.5). In terms of m it would lose its digits towards m = 1.
    """
    if modulus == 0:
        return math.inf
    a, b = 1.0, modulus
    while a - b > 1e-8 * a:  # convergence is quadratic: the next mean is right to rounding
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (a + b)


def _starting_phase(nutation: Nutation, roots: Roots, precise: bool) -> tuple[bool, Decimal]:
    """Return the nearer turning point (True: the upper) and v from there, at t = 0.

    v is an incomplete elliptic integral (DLMF 19.25.5). From the farther turning point it would be
    nearly complete, and the small distance from the nearer one would be lost in it. Halfway, at
    v = K/2, s2/s1 is sqrt(1 - m).
    """
    s1, s2, s3 = -roots.s1, roots.s2, roots.s3  # distances from the start, all >= 0
    s21, s31, s32 = roots.s21, roots.s31, roots.s32
    integral = integrate_rf if precise else _integrate_rf_in_doubles
    if s21 == 0:
        return False, ZERO
    if s2 * s2 * s31 >= s1 * s1 * s32:
        v = (s1 / s21).sqrt() * integral(s2 / s21, s3 / s31)
        return False, -v if nutation.u_dot < 0 else v
    v = (s2 * s31 / (s21 * s3)).sqrt() * integral(s32 * s1 / (s21 * s3), s32 / s3)
    return True, v if nutation.u_dot < 0 else -v


def _integrate_rf_in_doubles(x: Decimal, y: Decimal) -> Decimal:
    return Decimal(integrate_rf_in_doubles(float(x), float(y)))
