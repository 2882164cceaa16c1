"""Symmetric twins of a start: what is said of one must be said of the others, with bits that map.

The equations of motion keep their form if the world is mirrored, turned over (with -Mgl), turned
about the vertical, or measured in other units, and if the body is turned about its axis. Doubles
bear all of this without rounding if turns are half ones and units powers of two. So no reference is
needed, and no tolerance, but for theta and pi - theta, of which one is rounded.
"""

import dataclasses
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from physics.tops import EPS

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import (
    Motion,
    Solution,
    State,
    Top,
    clamp_verdict,
    hurry,
    kick_verdict,
    perrys_rule,
    solve_start,
)

Numbers4 = tuple[float, float, float, float]
Facts = dict[str, Any]

# What a number is multiplied by: powers of the units of time and of moments, and its signs in a
# mirror and in a world that is turned over. By the last part of a name.
QUANTITIES = {
    "dimensionless": (0, 0, 1, 1),
    "time": (1, 0, 1, 1),
    "speed": (-1, 0, 1, 1),  # a rate without a sign, and one of theta in a mirror
    "precession": (-1, 0, -1, -1),
    "spin": (-1, 0, -1, 1),
    "turns": (0, 0, -1, -1),
    "fall": (-1, 0, 1, -1),
    "acceleration": (-2, 0, 1, -1),
    "square": (-2, 0, 1, 1),
    "energy": (-2, 1, 1, 1),
    "vertical momentum": (-1, 1, -1, -1),
    "momentum": (-1, 1, -1, 1),
    "height": (0, 0, 1, -1),
}
NAMES = {
    "nutation_period": "time",
    "precession_period": "time",
    "farthest_time": "time",
    "rounding_shows_at": "time",
    "lowest_in": "time",
    "nutation_rate": "speed",
    "fast_top_nutation_rate": "speed",
    "rate_about_momentum": "speed",
    "critical_spin": "speed",
    "mean_precession_rate": "precession",
    "fast_top_precession_rate": "precession",
    "fast_top_rate": "precession",
    "regular_rates": "precession",
    "before": "precession",
    "after": "precession",
    "phi_dot": "precession",
    "mean_spin_rate": "spin",
    "psi_dot": "spin",
    "theta_dot": "fall",
    "precession_per_nutation": "turns",
    "turns": "turns",
    "theta_ddot": "acceleration",
    "theta_ddot_without": "acceleration",
    "mean_cosine": "height",
    "rates": "precession",
    "cosines": "height",
}
# Of these the name alone does not say it.
PLACES = {
    "place.rate": "precession",
    "average.rate": "precession",
    "clamp.rate": "speed",
}
ANGLES = ("turning_angles", "angles_without", "theta", "disturbed_to")
OF_CAUSE = (
    "torque_from_perpendicular",
    "momentum_from_axle",
    "omega_from_axle",
    "momentum_from_vertical",
)
OPPOSITES = (
    ("rises", "falls"),
    ("holds", "fails"),
    ("up", "down"),
    ("top", "axis"),
    ("higher", "lower"),
    (True, False),
)
# Words of which a world that is turned over has the opposite.
OVER = {word: other for pair in OPPOSITES for word, other in (pair, pair[::-1])}
TURNED_OVER = ("direction", "rule", "rule_holds", "effect", "subject", "height")
BESIDE = {"above": "below", "below": "above"}  # of a rate that changes its sign


@dataclass(frozen=True)
class Twin:
    """A symmetry: what it makes of a quaternion and of omega, and of what is said."""

    turn: Callable[[Any], Any] = lambda q: q
    spin: Callable[[Any], Any] = lambda omega: omega
    time: int = 0  # power of two of the unit
    moment: int = 0
    is_mirrored: bool = False
    is_over: bool = False

    def of_top(self, top: Top) -> Top:
        Ix, Iz, Mgl = top.moments
        weight = math.ldexp(-Mgl if self.is_over else Mgl, self.moment - 2 * self.time)
        return Top(math.ldexp(Ix, self.moment), math.ldexp(Iz, self.moment), weight)

    def of_time(self, t: float) -> float:
        return math.ldexp(t, self.time)

    def of_rates(self, omega: Any) -> Any:
        return tuple(math.ldexp(each, -self.time) for each in self.spin(omega))

    def of_state(self, state: State) -> State:
        q, omega = state.given_orientation.tolist(), state.angular_velocity.tolist()
        return State(self.turn(q), self.of_rates(omega))

    def map(self, name: str, value: Any) -> Any:
        """Return what a fact of a start is for its twin."""
        last = name.rsplit(".", 1)[-1]
        if isinstance(value, str | bool):
            return self._map_word(name, last, value)
        if not isinstance(value, float):
            return value
        place = ".".join(name.split(".")[-2:])
        return scale(self, PLACES.get(place) or NAMES.get(last, "dimensionless"), value)

    def _map_word(self, name: str, last: str, value: Any) -> Any:
        if name.endswith("place.kind"):
            return BESIDE.get(value, value) if self.is_mirrored != self.is_over else value
        is_lift = name.endswith(("highest.kind", "lowest.kind"))
        is_changed = self.is_over and (is_lift or last in TURNED_OVER)
        return OVER.get(value, value) if is_changed else value

    def find(self, name: str, others: Facts) -> Any:
        """Return the fact of a twin that a start has by a name: the highest point is its lowest."""
        if self.is_over:
            for here, there in ((".highest.", ".lowest."), (".lowest.", ".highest.")):
                if here in name:
                    return others.get(name.replace(here, there))
        return others.get(name)


def scale(twin: Twin, quantity: str, value: float) -> float:
    """Return the number of a twin."""
    time, moment, mirrored, over = QUANTITIES[quantity]
    sign = (mirrored if twin.is_mirrored else 1) * (over if twin.is_over else 1)
    return math.ldexp(sign * value, time * twin.time + moment * twin.moment)


TWINS = {
    "mirrored": Twin(
        lambda q: (q[0], q[1], -q[2], -q[3]), lambda o: (o[0], -o[1], -o[2]), is_mirrored=True
    ),
    "turned over": Twin(lambda q: (-q[1], q[0], -q[3], q[2]), is_over=True),
    "phi + pi": Twin(lambda q: (-q[3], -q[2], q[1], q[0])),
    "psi + pi": Twin(lambda q: (-q[3], q[2], -q[1], q[0]), lambda o: (-o[0], -o[1], o[2])),
    "phi + 2 pi": Twin(lambda q: tuple(-each for each in q)),
    "faster": Twin(time=-7),
    "slower": Twin(time=12),
    "larger": Twin(moment=10),
    "smaller": Twin(moment=-20, time=-3),
}


def list_facts(top: Top, state: State, t: float) -> Facts:
    """Return all that is said of a start, by name, and its state at a time."""
    motion = Motion(top, state)
    facts: Facts = {}
    for name in OF_A_MOTION:
        add(facts, f"motion.{name}", getattr(motion, name))
    for factor in (1.4, 0.5):
        for hold in ("spin_rate", "spin_momentum"):
            add(facts, f"verdict {factor} {hold}", perrys_rule(top, state, factor, hold))
    later = motion.at(t)
    facts["orientation"] = tuple(later.orientation.tolist())
    facts["angular_velocity"] = tuple(later.angular_velocity.tolist())
    if state.is_vertical:
        facts["stable"] = bool(top.sleeping_is_stable(state))
    else:
        add_kicks(facts, motion)
        add_clamp(facts, top, state)
    if not top.Mgl:  # which side of the pivot has the centre of mass
        facts = {name: value for name, value in facts.items() if not name.endswith("subject")}
    return facts


OF_A_MOTION = (
    "kind",
    "engine",
    "turning_angles",
    "nutation_period",
    "nutation_rate",
    "mean_precession_rate",
    "precession_period",
    "mean_spin_rate",
    "precession_per_nutation",
    "mean_cosine",
    "spin_reverses",
    "farthest_time",
    "rounding_shows_at",
    "fast_top_precession_rate",
    "fast_top_nutation_rate",
)


def add(facts: Facts, name: str, value: Any) -> None:
    """Add what is said, record by record."""
    if dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            add(facts, f"{name}.{field.name}", getattr(value, field.name))
    elif isinstance(value, tuple) and not all(isinstance(each, str) for each in value):
        facts[name] = tuple(float(each) for each in value)
    else:
        facts[name] = value


def add_kicks(facts: Facts, motion: Motion) -> None:
    state = motion.start
    for hold in ("spin_rate", "spin_momentum"):
        try:
            kicked = motion.restart(hurry(state, 1.4, hold))
        except RefusedError as error:
            facts[f"kick {hold}"] = type(error).__name__
            continue
        add(facts, f"kick {hold}", kick_verdict(kicked, state, hold))


def add_clamp(facts: Facts, top: Top, state: State) -> None:
    add(facts, "clamp", clamp_verdict(top, state))
    held = Motion(top, state, clamped=True)
    for name in OF_A_MOTION:
        add(facts, f"held.{name}", getattr(held, name))


def compare(twin: Twin, facts: Facts, others: Facts) -> Iterator[tuple[str, Any, Any]]:
    """Yield what is said of a start and not of its twin."""
    for name, value in facts.items():
        mapped, other = map_all(twin, name, value), twin.find(name, others)
        if not is_as_said(twin, name, mapped, other):
            yield name, value, other
    yield from ((name, None, other) for name, other in others.items() if name not in facts)


def map_all(twin: Twin, name: str, value: Any) -> Any:
    if name == "orientation":
        return twin.turn(value)
    if name == "angular_velocity":
        return twin.of_rates(value)
    if isinstance(value, tuple):
        return tuple(twin.map(name, each) for each in value)
    return twin.map(name, value)


def is_as_said(twin: Twin, name: str, value: Any, other: Any) -> bool:
    """Return whether a fact that was mapped is that of a twin."""
    last = name.rsplit(".", 1)[-1]
    if last == "facts":
        return set(value) == set(other)
    if last == "regular_rates" and len(value) == len(other) == 2 and abs(value[0]) == abs(value[1]):
        return set(value) == set(other)  # neither is the slow one
    of_mirror, of_world = IN_A_MIRROR.get(last), TURNED.get(last)
    if twin.is_mirrored and of_mirror:
        return of_mirror(value, other)
    if twin.is_over and of_world:
        return of_world(value, other)
    return is_same(value, other)


# Phases are integers that are truncated towards minus infinity, by 2^-62 of a turn: the image of a
# state in a mirror has other last bits, within the promise of 20 EPS of the attitude for both.
STATE = 20 * EPS
# A lift is the difference of two turning angles, each right to 2 EPS of at most pi.
LIFT = 4 * math.pi * EPS
# Angles of a cause come from those of theta in doubles: docs/derivation.md, section 14.
OF_A_CAUSE = 1e-7


def are_opposite(value: Any, other: Any) -> bool:
    """Return whether angles have the sum pi, each right to 2 EPS."""
    if isinstance(value, tuple):
        return all(map(are_opposite, value, reversed(other)))
    if value is None or other is None:
        return value is other
    return abs(value + other - math.pi) <= 2 * EPS * (value + other)


def are_near(value: Numbers4, other: Numbers4) -> bool:
    return all(abs(a - b) <= STATE for a, b in zip(value, other, strict=True))


def are_of_a_cause(value: Any, other: Any) -> bool:
    return all(abs(a - b) <= OF_A_CAUSE for a, b in zip(value, other, strict=True))


def is_as_far(value: float, other: float) -> bool:
    """Return whether times are equal, or one is the next power of two.

    Of a pole that is passed d counts as positive: phases that count whole turns the other way round
    differ by a nutation.
    """
    return value == other or 0.5 <= value / other <= 2


# What is rounded on the way to a twin, by the last part of the name.
IN_A_MIRROR: dict[str, Callable[[Any, Any], bool]] = {
    "orientation": are_near,
    "angular_velocity": lambda value, other: bool(value[2] == other[2]),
    "farthest_time": is_as_far,
}
TURNED: dict[str, Callable[[Any, Any], bool]] = {
    **dict.fromkeys(ANGLES, are_opposite),
    **dict.fromkeys(OF_CAUSE, are_of_a_cause),
    "amount": lambda value, other: abs(value - other) <= LIFT,
}


def is_same(value: Any, other: Any) -> bool:
    if isinstance(value, tuple):
        return (
            isinstance(other, tuple)
            and len(value) == len(other)
            and all(map(is_same, value, other))
        )
    if isinstance(value, float) and isinstance(other, float) and math.isnan(value):
        return math.isnan(other)
    return bool(value == other)


# ---- Starts from what is seen ----

# What is known, by its quantity; the tilt of a world that is turned over would be rounded.
KNOWN = {
    "theta": "dimensionless",
    "dip": "dimensionless",
    "precession_period": "time",
    "nutation_period": "time",
    "psi_dot": "spin",
    "alpha": "square",
    "a": "spin",
    "b": "precession",
    "energy": "energy",
    "p_phi": "vertical momentum",
    "p_psi": "momentum",
}


def map_known(twin: Twin, known: dict[str, float]) -> dict[str, float]:
    """Return what is known of a twin."""
    return {name: scale(twin, KNOWN[name], value) for name, value in known.items()}


def solve_all(top: Top, known: dict[str, float]) -> Any:
    """Return all starts that have what is known, or the name that is refused."""
    try:
        return solve_start(top, **known)
    except RefusedError as error:
        return str(error).split()[0]


def are_twins(twin: Twin, starts: Any, others: Any) -> bool:
    """Return whether all starts of a twin are those of the others, in any order."""
    if isinstance(starts, str) or isinstance(others, str):
        return bool(starts == others)
    left = list(others)
    for start in starts:
        found = [other for other in left if is_twin(twin, start, other)]
        if not found:
            return False
        left.remove(found[0])
    return not left


def is_twin(twin: Twin, start: Solution, other: Solution) -> bool:
    if not twin.is_over:
        return all(
            twin.map(name, getattr(start, name)) == getattr(other, name)
            for name in ("theta", "theta_dot", "phi_dot", "psi_dot")
        )
    # Each number is right to some EPS, and theta' of an axis on the vertical has no sign.
    rates = [twin.map("phi_dot", start.phi_dot), start.psi_dot, start.theta_dot]
    seen = [other.phi_dot, other.psi_dot, other.theta_dot]
    size = max(map(abs, rates))
    return are_opposite(start.theta, other.theta) and all(
        abs(a - b) <= SOLVED * size for a, b in zip(rates, seen, strict=True)
    )


SOLVED = 16 * EPS
