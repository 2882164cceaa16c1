"""An adversary of the promises: it climbs from random cases towards larger errors.

    PYTHONPATH=test python -m physics.adversary [EVALUATIONS] [NAME...]

prints, for each promise of docs/accuracy.md, filters.md and many.md, the largest part of it that
was reached, and the case. Rounding is a rough landscape: a step changes all last bits, and keeps
what makes an error large, such as the place in the nutation or the gap to the separatrix.
"""

import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from drawn import Numbers
from mpmath import mp, mpf
from physics import differences
from physics.proofs import ATTITUDE, RATES, find_errors
from physics.tops import (
    EPS,
    FAMILIES,
    attitude_error,
    error,
    exact_euler,
    exact_parts,
    random_case,
    turn,
)

from symtop_ros.physics import (
    Friction,
    Motion,
    Motions,
    State,
    Top,
    regular_precession_rates,
    set_precession_rate,
)
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, Series

EVALUATIONS = 20_000
KEPT, DRAWN = 30, 5  # cases to climb from; one in so many is drawn anew
STYLES = (*FAMILIES, "separatrix", "swing")
Genes = Sequence[Any]


@dataclass(frozen=True)
class Promise:
    """A promise: cases, the part of it that an error is, and how many there is time for."""

    draw: Callable[[Numbers], Genes]
    measure: Callable[[Genes], float]
    most: int = EVALUATIONS


def climb(promise: Promise, evaluations: int, seed: str) -> tuple[float, Genes]:
    """Return the largest part of the promise that was reached, and its case."""
    rng = Numbers(seed)
    best = [(0.0, promise.draw(Numbers(seed)))]
    evaluations = min(evaluations, promise.most)
    for number in range(evaluations):
        is_new = number < evaluations // DRAWN or rng.randrange(DRAWN) == 0
        genes = promise.draw(rng) if is_new else change(rng.choice(best)[1], rng)
        best.append((try_to_measure(promise, genes), genes))
        best = sorted(best, key=lambda each: -each[0])[:KEPT]
    return best[0]


def change(genes: Genes, rng: Numbers) -> Genes:
    """Return a case near the given one: numbers change, in large steps or in small ones."""
    size = rng.power(-7, -0.5)
    return [
        gene * (1 + size * rng.gauss()) if isinstance(gene, float) and rng.random() < 0.4 else gene
        for gene in genes
    ]


def try_to_measure(promise: Promise, genes: Genes) -> float:
    """Return the part of the promise, 0 of a case that is refused, and infinity for NaN."""
    try:
        part = float(promise.measure(genes))
    except ValueError:
        return 0.0
    return math.inf if math.isnan(part) else part


# ---- Motions under gravity ----


def draw_motion(rng: Numbers) -> Genes:
    """A style, Ix, Iz, Mgl, orientation, angular velocity and time; or fewer of some styles."""
    style = rng.choice(STYLES)
    if style == "separatrix":  # exactly on it, in multiples of 2^-10
        return [
            style,
            rng.uniform(-9, 9),
            rng.uniform(-9, 9),
            rng.uniform(0.02, 2),
            rng.uniform(-2, 2),
        ]
    if style == "swing":  # a pendulum from anywhere, in some swings
        return [
            style,
            *rng.quaternions(1)[0].tolist(),
            rng.uniform(-9, 9),
            rng.uniform(-9, 9),
            rng.uniform(0.02, 2),
            rng.power(-1, 2),
            rng.uniform(-6, 6),
        ]
    case = random_case(rng.randrange(10**9), style)
    state = case.start.given_orientation.tolist(), case.start.angular_velocity.tolist()
    return [style, *case.top.moments, *state[0], *state[1], case.t]


def build_motion(genes: Genes) -> tuple[Motion, float]:
    """Return the motion and the time of a case."""
    style, *numbers = genes
    if style == "separatrix":
        x, y, ratio, t = numbers
        x, y, ratio = (
            round(x * 1024) / 1024,
            round(y * 1024) / 1024,
            round(ratio * 64) / 64 or 1 / 64,
        )
        top = Top(1.0, ratio, (x * x + y * y) / 2)
        q = (0.5, 0.5, 0.5, 0.5)
        return Motion(top, State(q, (x, y, y / ratio))), t
    if style == "swing":
        *q, x, y, ratio, weight, t = numbers
        return Motion(Top(1.0, ratio, weight), State(normalize(q), (x, y, 0.0))), t / math.sqrt(
            weight
        )
    Ix, Iz, Mgl, *state, t = numbers
    return Motion(Top(Ix, min(Iz, 2 * Ix), Mgl), State(normalize(state[:4]), state[4:])), t


def normalize(q: Genes) -> Any:
    """Return a quaternion of norm 1 to rounding."""
    return np.array(q) / math.sqrt(sum(each * each for each in q))


def measure_attitude(genes: Genes) -> float:
    """20 eps as an angle; a bound that is proved."""
    return float(find_errors(*build_motion(genes))[0].upper()) / ATTITUDE


def measure_angular_velocity(genes: Genes) -> float:
    """10 eps of the largest |omega_xy|; a bound that is proved."""
    return float(find_errors(*build_motion(genes))[1].upper()) / RATES


def draw_passage(rng: Numbers) -> Genes:
    """Rates at a pole, Iz/Ix, weight, phi, and a time in s after it has been passed again."""
    rates = [rng.choice((-1, 1)) * rng.power(-1, 1), rng.choice((0.0, rng.uniform(-5, 5)))]
    shape = [rng.uniform(0.05, 1.9), rng.uniform(-3, 3)]
    return [*rates, *shape, rng.uniform(-3, 3), rng.power(-3, -1), rng.choice((1, 2, 7, 1000))]


def measure_tilt_at_a_pole(genes: Genes) -> float:
    """10 eps of the tilt, down to 1e-3 rad."""
    theta_dot, psi_dot, ratio, weight, phi, offset, count = genes
    start = State.from_euler(theta=0.0, theta_dot=theta_dot, psi_dot=psi_dot, psi=phi)
    motion = Motion(Top(1.0, ratio, weight), start)
    if motion.kind != "through the pole":
        return 0.0
    t = motion.nutation_period * count + offset
    tilt = motion.at(t).euler_angles.theta
    if not 1e-3 < tilt < 0.05:
        return 0.0
    with mp.workdps(40):
        (_, exact, _), _ = exact_euler(*ClosedForm(Inputs.of(motion.top, start), 50).at(t))
        return abs(tilt - exact) / (10 * EPS * exact)


# ---- Motions with friction or a torque ----


def draw_driven(rng: Numbers) -> Genes:
    """Ratio, weight, angles, rates, friction, torque and time of some rad."""
    drive = [rng.choice((0.0, rng.power(-6, 0))) for _ in range(5)]
    drive[rng.randrange(5)] = rng.power(-6, 0)  # without any it is a motion under gravity alone
    angles = [rng.uniform(0.05, 3.0), rng.uniform(-3, 3), rng.uniform(-3, 3)]
    rates = [rng.uniform(-3, 3) for _ in range(3)]
    return [
        rng.uniform(0.05, 1.9),
        rng.uniform(-3, 3),
        *angles,
        *rates,
        *drive,
        rng.uniform(-0.5, 1),
    ]


def measure_driven(genes: Genes) -> float:
    """The larger part of eps (4 + growth/10): attitude, and omega of the largest one."""
    ratio, weight, theta, phi, psi, *rest = genes
    rates = rest[:3]
    friction = rest[3:5]
    torque = rest[5:8]
    t = rest[8]
    top = Top(1.0, ratio, weight)
    names = ("theta_dot", "phi_dot", "psi_dot")
    start = State.from_euler(theta=theta, phi=phi, psi=psi, **dict(zip(names, rates, strict=True)))
    drag = Friction(*map(abs, friction))
    motion = Motion(top, start, drag, tuple(torque))
    inputs = Inputs.of(top, start)
    drive = (drag.axial, drag.transverse), tuple(torque)
    state = motion.at(t)
    q, omega = Series(inputs, 30, *drive).at(t)
    shift = Fraction(1, 10**9)
    faster = tuple(each * (1 + shift) for each in inputs.angular_velocity)
    other, _ = Series(inputs._replace(angular_velocity=faster), 30, *drive).at(t)
    with mp.workdps(30):
        growth = float(
            2
            * mp.norm([a - b for a, b in zip(q, other, strict=True)])
            / mpf(shift.numerator)
            * shift.denominator
        )
    promised = EPS * (4 + growth / 10)
    largest = np.abs(motion.at(np.linspace(0, t, 50)).angular_velocity).max()
    off = error(omega, state.angular_velocity) / float(largest)
    return max(2 * attitude_error(q, state.orientation), off) / promised


# ---- One state ----


def draw_state(rng: Numbers) -> Genes:
    """A quaternion anywhere, or with parts down to 1e-9, and rates."""
    parts = [
        rng.choice((-1, 1)) * rng.choice((1.0, rng.power(-9, 0))) * rng.random() for _ in range(4)
    ]
    return [*parts, *(rng.choice((-1, 1)) * rng.power(-3, 3) for _ in range(3))]


def build_state(genes: Genes) -> State:
    """Return the state of a case."""
    return State(normalize(genes[:4]), genes[4:7])


def find_norm_error(state: State) -> Any:
    """Return how far the norm of the quaternion is from 1."""
    return abs(mp.norm([mpf(part) for part in state.orientation.tolist()]) - 1)


def measure_theta(genes: Genes) -> float:
    """5 eps of itself."""
    state = build_state(genes)
    with mp.workdps(40):
        (_, theta, _), _ = exact_euler(*exact_parts(state))
        return abs(state.euler_angles.theta - theta) / (5 * EPS * theta)


def measure_phi_and_psi(genes: Genes) -> float:
    """5 eps of half a turn."""
    state = build_state(genes)
    with mp.workdps(40):
        (phi, _, psi), _ = exact_euler(*exact_parts(state))
        found = state.euler_angles
        turns = [(a - b) / (2 * mp.pi) for a, b in ((found.phi, phi), (found.psi, psi))]
        return max(abs(each - mp.nint(each)) * 2 for each in turns) / (5 * EPS)


def measure_euler_rates(genes: Genes) -> float:
    """12 eps of the angular velocity over sin(theta), and twice what the norm is off."""
    state = build_state(genes)
    with mp.workdps(40):
        q, omega = exact_parts(state)
        (_, theta, _), rates = exact_euler(q, omega)
        off = max(abs(a - b) for a, b in zip(state.euler_rates, rates, strict=True))
        return off * mp.sin(theta) / ((12 * EPS + 2 * find_norm_error(state)) * mp.norm(omega))


def measure_vectors(genes: Genes) -> float:
    """8 eps of torque and angular momentum, and twice what the norm is off."""
    state = build_state(genes)
    top = Top(1.0, 0.7, 2.0)
    with mp.workdps(40):
        q, (wx, wy, wz) = exact_parts(state)
        axis = turn(q, [mpf(0), mpf(0), mpf(2)])
        exact = [-axis[1], axis[0], mpf(0)], turn(q, [wx, wy, mpf(0.7) * wz])
        off = find_norm_error(state)
        found = top.gravity_torque(state).tolist(), top.angular_momentum(state).tolist()
        return max(
            mp.norm([mpf(a) - b for a, b in zip(one, other, strict=True)])
            / ((8 * EPS + 2 * off) * mp.norm(other))
            for one, other in zip(found, exact, strict=True)
        )


def measure_kick(genes: Genes) -> float:
    """A new phi' within 15 eps of the larger angular velocity over sin(theta), and the same."""
    state = build_state(genes)
    rate = genes[7]
    kicked = set_precession_rate(state, rate)
    before = mp.norm(state.angular_velocity.tolist())
    with mp.workdps(40):
        q, omega = exact_parts(kicked)
        (_, theta, _), (phi_dot, _, _) = exact_euler(q, omega)
        promised = (15 * EPS + 2 * find_norm_error(state)) * max(mp.norm(omega), before)
        return abs(phi_dot - rate) * mp.sin(theta) / promised


def draw_angles(rng: Numbers) -> Genes:
    """Angles of up to 1e4 rad."""
    return [rng.uniform(-1, 1) * rng.power(-9, 4) for _ in range(3)]


def measure_from_euler(genes: Genes) -> float:
    """2 eps, as the distance of quaternions."""
    phi, theta, psi = (min(max(each, -1e4), 1e4) for each in genes)
    state = State.from_euler(phi=phi, theta=theta, psi=psi)
    with mp.workdps(40):
        plus = (mpf(phi) + mpf(psi)) / 2
        minus = (mpf(phi) - mpf(psi)) / 2
        c, s = mp.cos(mpf(theta) / 2), mp.sin(mpf(theta) / 2)
        q = c * mp.cos(plus), s * mp.cos(minus), s * mp.sin(minus), c * mp.sin(plus)
        return attitude_error(q, state.given_orientation) / (2 * EPS)


def draw_precession(rng: Numbers) -> Genes:
    """Iz, Mgl, theta and psi' for Ix = 1."""
    return [rng.uniform(0.02, 2), rng.uniform(-3, 3), rng.power(-6, 0.5), rng.uniform(-9, 9)]


def measure_regular_rates(genes: Genes) -> float:
    """The nearest doubles: half a unit in the last place, which any double may be off."""
    Iz, Mgl, theta, spin = genes
    with mp.workdps(60):
        a = (1 - mpf(Iz)) * mp.cos(mpf(theta))
        b = mpf(Iz) * mpf(spin)
        root = mp.sqrt(b * b - 4 * a * mpf(Mgl))
        q = (b + mp.sign(b) * root) / 2
        exact = sorted((mpf(Mgl) / q, q / a), key=abs)
        rates = regular_precession_rates(Top(1.0, Iz, Mgl), theta, spin)
        off = [abs(mpf(r) - x) / math.ulp(r) for r, x in zip(rates, exact, strict=False) if r]
        return 0.0 if max(off, default=0) <= 0.5 else math.inf


# ---- Many motions, and derivatives ----


def measure_many(genes: Genes) -> float:
    """The bits of the motion alone."""
    motion, t = build_motion(genes)
    moments = [[each, 1.0] for each in motion.top.moments[:2]] + [[motion.top.Mgl, 1.0]]
    parts = motion.start.given_orientation, motion.start.angular_velocity
    starts = State(
        *(
            np.stack((part, other))
            for part, other in zip(parts, ((1, 0, 0, 0), (1, 0, 0)), strict=True)
        )
    )
    among = Motions(Top(*moments), starts).at([t, -t, t / 3])[0]
    alone = [motion.at(each) for each in (t, -t, t / 3)]
    same = all(
        one.tobytes() == other.tobytes()
        for state, single in zip(among, alone, strict=True)
        for one, other in zip(state._parts, single._parts, strict=True)
    )
    return 0.0 if same else math.inf


def draw_derivatives(rng: Numbers) -> Genes:
    """A motion within some nutations, not near what is refused."""
    angles = [rng.uniform(0.01, 3.1), rng.uniform(-3, 3), rng.uniform(-3, 3)]
    rates = [rng.uniform(-5, 5) for _ in range(3)]
    return [rng.uniform(0.05, 1.9), rng.uniform(0.1, 3), *angles, *rates, rng.power(-2, 1)]


def measure_derivatives(genes: Genes) -> float:
    """1e-8 of the largest element of a block, or what is left of a parameter that hardly counts."""
    ratio, weight, theta, phi, psi, theta_dot, phi_dot, psi_dot, t = genes
    rates = {"theta_dot": theta_dot, "phi_dot": phi_dot, "psi_dot": psi_dot}
    motion = Motion(
        Top(1.0, ratio, weight), State.from_euler(theta=theta, phi=phi, psi=psi, **rates)
    )
    exact = differences.differentiate(motion, [abs(t)], differences.FEW_DIGITS)
    found = motion.jacobian([abs(t)])
    return float(differences.find_errors(motion, found, exact, counts_start=True).max()) / 1e-8


PROMISES = {
    "attitude": Promise(draw_motion, measure_attitude),
    "angular velocity": Promise(draw_motion, measure_angular_velocity),
    "tilt at a pole": Promise(draw_passage, measure_tilt_at_a_pole),
    "friction and torques": Promise(draw_driven, measure_driven, 4000),  # some minutes
    "theta": Promise(draw_state, measure_theta),
    "phi and psi": Promise(draw_state, measure_phi_and_psi),
    "Euler rates": Promise(draw_state, measure_euler_rates),
    "torque and angular momentum": Promise(draw_state, measure_vectors),
    "a kick's rate": Promise(lambda rng: [*draw_state(rng), rng.uniform(-99, 99)], measure_kick),
    "from_euler": Promise(draw_angles, measure_from_euler),
    "regular rates": Promise(draw_precession, measure_regular_rates),
    "many as alone": Promise(draw_motion, measure_many),
    "derivatives": Promise(draw_derivatives, measure_derivatives, 1000),  # 0.3 s for each
}


def main(words: Sequence[str]) -> None:
    """Print what is reached of each promise, or of those that are named."""
    evaluations = int(words[0]) if words else EVALUATIONS
    for name in words[1:] or PROMISES:
        begin = time.monotonic()
        part, genes = climb(PROMISES[name], evaluations, name)
        print(f"{name:28} {part:6.3f}  {time.monotonic() - begin:6.0f} s  {genes}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
