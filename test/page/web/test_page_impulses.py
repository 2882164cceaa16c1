"""The impulses of a fall that the page shows, compared with integrals of 30 digits."""

import math

import pytest
from drawn import Numbers
from mpmath import mp, mpf
from trials import trials

from symtop_ros.physics import Motion, State, Top

# The promise of docs/panel.md, of the sizes of the parts. What the page knows of the motion, its
# turning angles and states, is right to some EPS of a rate, or to its square root for a small
# range of tilts; 1e-9 is above both for the starts below.
BOUND = 1e-9
# Next to the ends phi' may have a spike, as wide as the tilt there: parts become ever shorter.
CUTS = [0, 1e-4, 1e-3, 1e-2, 0.1, 0.5]


def draw_start(rng):
    """A start with theta' = 0: anywhere, or next to the vertical, where it falls or has risen."""
    Ix = rng.power(-4, 0)
    unit = rng.power(0, 1.5)
    top = Top(Ix, Ix * rng.uniform(0.1, 2.0), rng.choice([1, 1, -1]) * Ix * unit * unit)
    theta = rng.choice([rng.uniform(0.1, 3.0), rng.power(-2.5, -0.5)])
    spin = rng.choice([rng.uniform(-10, 10), rng.uniform(0.1, 2.0)]) * unit
    phi_dot = rng.choice([0.0, 0.0, rng.uniform(-3, 3)]) * unit
    return top, theta, phi_dot, spin


def integrate(top, start):
    """Impulses of half a nutation, from the doubles of a start, of which theta' = 0.

    The cubic of the height is s (f1 + f2 s + beta s^2) with s = u - u0. With the other turning
    point s1 and s = s1 sin^2(x) it leaves dx/dt = sqrt(-f2 - beta (s1 + s))/2.
    """
    Ix, Iz, Mgl = map(mpf, (top.Ix, top.Iz, top.Mgl))
    w, x, y, z = map(mpf, start.orientation.tolist())
    wx, wy, wz = map(mpf, start.angular_velocity.tolist())
    norm = w * w + x * x + y * y + z * z
    above, below = 2 * (x * x + y * y) / norm, 2 * (w * w + z * z) / norm  # 1 - u0 and 1 + u0
    u = 1 - above
    square = above * below
    along = 2 * (wx * (x * z - w * y) + wy * (y * z + w * x)) / norm  # sin^2(theta) phi'
    a = Iz * wz / Ix
    beta = 2 * Mgl / Ix
    across = along**2 / square
    f1 = 2 * a * along - 2 * u * across - beta * square
    f2 = 2 * beta * u - across - a * a
    root = mp.sqrt(f2 * f2 - 4 * beta * f1)
    ends = [(-f2 + sign * root) / (2 * beta) for sign in (1, -1)]
    end = min((each for each in ends if each * f1 > 0), key=abs)

    def torque(at, part):
        s = end * mp.sin(at) ** 2
        height = u + s
        level = (above - s) * (below + s)
        phi_dot = (along - a * s) / level
        psi_dot = wz - phi_dot * height
        factor = 2 * mp.sqrt(level / (-f2 - beta * (end + s)))  # sin(theta) dt/dx
        coriolis = -Iz * psi_dot * phi_dot
        centrifugal = (Ix - Iz) * phi_dot**2 * height
        return (Mgl, coriolis, centrifugal)[part] * factor

    points = [mpf(each) for each in CUTS]
    points = [*points, *(mp.pi / 2 - each for each in reversed(points))]
    return [
        float(mp.quad(lambda at, part=part: torque(at, part), points, method="gauss-legendre"))
        for part in range(3)
    ]


@pytest.mark.slow
@pytest.mark.parametrize("count", trials(30, 2000))
def test_impulses_are_integrals_of_thirty_digits(tab, count):
    rng = Numbers("impulses")
    starts = [draw_start(rng) for _ in range(count)]
    cases = [
        [{"Ix": top.Ix, "Iz": top.Iz, "Mgl": top.Mgl}, theta, phi, 0.0, psi]
        for top, theta, phi, psi in starts
    ]
    for start, (half, found, texts) in zip(
        starts, tab.evaluate("findImpulses", cases), strict=True
    ):
        top, theta, phi, psi = start
        state = State.from_euler(theta=theta, phi_dot=phi, psi_dot=psi)
        low, high = Motion(top, state).turning_angles
        if high - low < 1e-3:
            continue  # the range itself has lost its digits
        with mp.workdps(30):
            wanted = integrate(top, state)
        size = sum(map(abs, wanted))
        assert found[-1] == pytest.approx(wanted, rel=0, abs=BOUND * size), start
        # Their sum is Ix theta', at the nanosecond that is next to the turning point.
        left = top.Ix * Motion(top, state).at(round(half * 1e9) / 1e9).euler_rates.theta_dot
        assert abs(float(texts[-1]) / 1e3 - left) <= 1e-6 * size + 1e-3 * abs(left), start


@pytest.mark.parametrize("count", trials(50, 1000))
def test_on_the_way_the_sum_is_the_change_of_theta_dot(tab, count):
    rng = Numbers("sums of impulses")
    cases, moved = [], []
    for _ in range(count):
        top, theta, phi, psi = draw_start(rng)
        rate = rng.uniform(-1, 1) * math.sqrt(abs(top.Mgl) / top.Ix)
        state = State.from_euler(theta=theta, phi_dot=phi, theta_dot=rate, psi_dot=psi)
        cases.append([{"Ix": top.Ix, "Iz": top.Iz, "Mgl": top.Mgl}, theta, phi, rate, psi])
        moved.append((top, Motion(top, state)))
    for case, (top, motion), (half, found, _) in zip(
        cases, moved, tab.evaluate("findImpulses", cases), strict=True
    ):
        for share, parts in zip((0.3, 0.9, 1.0), found, strict=True):
            change = (
                motion.at(share * half).euler_rates.theta_dot - motion.start.euler_rates.theta_dot
            )
            size = sum(map(abs, parts)) + top.Ix * abs(change)
            assert sum(parts) == pytest.approx(top.Ix * change, rel=0, abs=10 * BOUND * size), case
