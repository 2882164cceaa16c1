"""Energy and momenta that are exchanged in an interval of a motion, and their causes.

The kernel forms changes between two states as products (`rule/exchange.hpp`), so that nothing is
lost in large numbers that cancel. A ledger has these changes. An exchange is the record from which
a sentence about them is written; it leaves out changes that may be rounding errors.
"""

import math
from collections.abc import Iterator
from dataclasses import astuple, dataclass, field
from functools import partial
from itertools import pairwise, starmap
from operator import add
from typing import Literal

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.deprecation import OldName
from symtop_ros.base.refusals import Words, refuse, require, show, show_limit
from symtop_ros.physics.dynamics import find_fastest_rate
from symtop_ros.physics.kernel.bindings import find_exchange
from symtop_ros.physics.kernel.records import EnergiesRecord, ExchangeRecord
from symtop_ros.physics.motion import Motion, Piece
from symtop_ros.physics.state import State
from symtop_ros.physics.times import SECOND, ExactTimes
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import validate_number, validate_one
from symtop_ros.words import write

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(24)  # exact to rounding over a part
STEP = 2.0  # rad of the fastest rate in a part
MOST_PARTS = 30_000  # of a stretch with friction or a torque: some seconds
SLIP = 1e-9  # of half a nutation, by which rounding may move a turning point
HALVINGS = 80  # of the half nutation in which a turning point is found: down to rounding
MILLI = 1e3
ROUNDING = 1e-12  # of the sizes at both ends: far above the rounding of states; less is rounding

Part = Literal["weight", "precession", "nutation", "spin"]
CauseName = Literal["pushes", "clamp", "friction", "torque"]
Momentum = Literal["p_phi", "p_psi"]
PARTS: tuple[Part, ...] = ("weight", "precession", "nutation", "spin")
CAUSES: tuple[CauseName, ...] = ("pushes", "clamp", "friction", "torque")


@dataclass(frozen=True, slots=True)
class Energies:
    """Gains of the parts of the energy, in J; a loss is negative.

    Attributes
    ----------
    weight : float
        Gain of the potential energy Mgl cos(theta).
    precession : float
        Gain of Ix phi'^2 sin^2(theta)/2, which is zero on the vertical.
    nutation : float
        Gain of Ix theta'^2/2.
    spin : float
        Gain of p_psi^2/(2 Iz).
    """

    weight: float
    precession: float
    nutation: float
    spin: float

    @property
    def total(self) -> float:
        """Gain of the energy."""
        return self.weight + self.precession + self.nutation + self.spin


@dataclass(frozen=True, slots=True, eq=False)
class Contribution:
    """Energy and momenta that one cause adds to a top in an interval; negative if it removes them.

    Attributes
    ----------
    work : float
        In J.
    vertical_momentum, axial_momentum : float
        Changes of p_phi and of p_psi, in N m s.
    angular_impulse : ndarray (3,)
        Change of the angular momentum, world frame, in N m s.
    """

    work: float
    vertical_momentum: float
    axial_momentum: float
    angular_impulse: Real

    def __add__(self, other: "Contribution") -> "Contribution":
        """Return both together."""
        return Contribution(*map(add, astuple(self), astuple(other)))


NOTHING = Contribution(0.0, 0.0, 0.0, np.zeros(3))
NOTHING.angular_impulse.setflags(write=False)  # it is that of many ledgers


@dataclass(frozen=True, slots=True, eq=False)
class Ledger:
    """Changes of energy, p_phi, p_psi and angular momentum in an interval of a motion.

    Attributes
    ----------
    begin, end : float
        Times of the interval in s.
    gained : Energies
        Gains of the weight, the precession, the nutation and the spin.
    gravity : Contribution
        Its work is the energy that the weight has lost; it does not change p_phi and p_psi.
    pushes : Contribution
        The share of the pushes after `begin`, up to `end`. The first push, which leads to the start
        of the motion, is in no interval. A push of J gives J sin(theta) to p_phi and nothing to
        p_psi.
    clamp : Contribution
        The share of the hand that holds phi: it does no work, and changes p_phi only.
    friction, torque : Contribution
        The shares of friction and of the applied torque.
    sizes : Energies
        For each part, its larger absolute value at the two ends; for the weight |Mgl|.
    momentum_size : float
        A bound in N m s of the momenta at both ends.

    Examples
    --------
    On the way down, the weight gives all the energy that the precession has at the lowest point:

    >>> from symtop_ros.physics import Ledger, Motion, State, Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> fall = Ledger.from_times(motion, 0.0, motion.nutation_period / 2)
    >>> round(1e3 * fall.gravity.work, 2), round(1e3 * fall.gained.precession, 2)  # mJ
    (6.12, 6.12)
    >>> print(fall)
    In 0.0798 s the weight gave 6.12 mJ, the precession got 6.12 mJ; p_phi and p_psi are constant.
    """

    begin: float
    end: float
    gained: Energies
    gravity: Contribution
    pushes: Contribution
    clamp: Contribution
    friction: Contribution
    torque: Contribution
    sizes: Energies
    momentum_size: float

    of, between_turns = OldName("from_times"), OldName("from_turns")

    @classmethod
    def from_times(cls, motion: Motion, begin: float, end: float) -> "Ledger":
        """Return the ledger of the interval between two times.

        Parameters
        ----------
        motion : Motion
            One motion, also with pushes, a clamp, friction or a torque.
        begin, end : float
            Times in s, begin <= end. A push at `begin` does not belong to the interval.

        Raises
        ------
        ValueError
            If a time is refused, or if the interval is too long for the quadrature of friction and
            torques, which uses at most 30 000 parts of 2 rad of the fastest rate.

        Examples
        --------
        Nineteen pushes along the precession after the first one:

        >>> from symtop_ros.physics import Ledger, Motion, State, Top
        >>> from symtop_ros.physics import Pushes, push_axle, regular_precession_rates
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> slow, _ = regular_precession_rates(top, 0.5, 200.0)
        >>> start = State.from_euler(theta=0.5, phi_dot=slow, psi_dot=200.0)
        >>> motion = Motion(top, push_axle(top, start, 5e-5), pushes=Pushes(5e-5, 20.0, 20))
        >>> pushes = Ledger.from_times(motion, 0.0, 1.0).pushes
        >>> round(pushes.vertical_momentum, 8), pushes.axial_momentum
        (0.00040678, 0.0)
        """
        validate_one(motion, "motion")
        begin, end = validate_number("begin", begin, "s"), validate_number("end", end, "s")
        require(begin <= end, "end", f"at least begin = {show_limit(begin)} s", end)
        top, first, last = motion.top, motion.at(begin), motion.at(end)
        exchange = _exchange(top, first, last)
        gained = _read_energies(exchange.gained)
        pieces = _list_pieces(motion, begin, end)
        impulse = getattr(motion.pushes, "impulse", 0.0)
        pushes = sum(starmap(partial(_push, impulse), pairwise(pieces)), NOTHING)
        clamp = _hold(top, first, last, exchange.height) if motion.clamped else NOTHING
        found = _integrate_pieces(pieces, begin, end) if motion.is_driven else _Integrals()
        pulled = found.gravity
        if not motion.is_driven:  # all that the others did not give
            change = top.angular_momentum(last) - top.angular_momentum(first)
            pulled = change - pushes.angular_impulse - clamp.angular_impulse
        gravity = Contribution(-gained.weight, 0.0, 0.0, pulled)
        causes = gravity, pushes, clamp, found.friction, found.torque
        sizes = _read_energies(exchange.sizes)
        return cls(begin, end, gained, *causes, sizes, exchange.momentum_size)

    @classmethod
    def from_turns(cls, motion: Motion, t: float) -> "Ledger":
        """Return the ledger of the half nutation between the last two turning points up to a time.

        Parameters
        ----------
        motion : Motion
            One motion under gravity alone, or clamped.
        t : float
            Time in s.

        Raises
        ------
        ValueError
            If theta does not turn, if friction, a torque or pushes act, or if the time is refused.

        Examples
        --------
        >>> from symtop_ros.physics import Ledger, Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> rise = Ledger.from_turns(motion, 0.2)
        >>> round(rise.begin, 4), round(rise.end, 4), round(1e3 * rise.gained.weight, 2)
        (0.0798, 0.1595, 6.12)
        """
        validate_one(motion, "motion")
        t, half = validate_number("t", t, "s"), motion.nutation_period / 2
        acting = motion.is_driven or motion.pushes
        require(not acting, "motion", "one without friction, torque and pushes", motion.kind)
        low, high = motion.turning_angles
        if not (math.isfinite(half) and low < high):
            raise refuse(
                "motion", "one whose theta turns", Words(f"a motion that is {motion.kind}")
            )
        last = _find_turn(motion, t, half)
        return cls.from_times(motion, last - half, last)

    def __str__(self) -> str:
        """Return the exchange of energy, p_phi and p_psi in words."""
        return str(Exchange.from_ledger(self))

    @property
    def vertical_momentum(self) -> float:
        """Gain of p_phi in N m s."""
        return sum(each.vertical_momentum for each in self._causes)

    @property
    def axial_momentum(self) -> float:
        """Gain of p_psi in N m s."""
        return sum(each.axial_momentum for each in self._causes)

    @property
    def angular_momentum(self) -> Real:
        """Gain of the angular momentum (3,), world frame, in N m s."""
        return np.asarray(sum(each.angular_impulse for each in (self.gravity, *self._causes)))

    @property
    def work(self) -> float:
        """Work of all causes except gravity in J; it is the total gain of the energy."""
        return sum(each.work for each in self._causes)

    @property
    def _causes(self) -> tuple[Contribution, ...]:
        return self.pushes, self.clamp, self.friction, self.torque


@dataclass(frozen=True, slots=True)
class Share:
    """Energy in mJ that a part of the energy got or gave, or that a cause gave or took."""

    kind: Literal["gave", "got", "took"]
    who: Part | CauseName
    amount: float


@dataclass(frozen=True, slots=True)
class Gift:
    """The momentum in N m s that a cause added to p_phi or p_psi, or removed from it."""

    kind: Literal["gave", "took"]
    who: CauseName
    amount: float
    name: Momentum


@dataclass(frozen=True, slots=True)
class Momenta:
    """Changes of p_phi and p_psi, by their causes."""

    kind: Literal["kept", "changed"]
    gifts: tuple[Gift, ...]


@dataclass(frozen=True, slots=True)
class Exchange:
    """Energy and momenta that parts and causes exchange in an interval; givers come first."""

    kind: Literal["energy", "none"]
    duration: float  # s
    shares: tuple[Share, ...]
    momenta: Momenta

    of = OldName("from_ledger")

    @classmethod
    def from_ledger(cls, ledger: Ledger) -> "Exchange":
        """Return the exchange of a ledger."""
        shares = sorted(_list_shares(ledger), key=lambda each: each.kind != "gave")
        gifts = tuple(_list_gifts(ledger))
        return cls(
            "energy" if shares else "none",
            ledger.end - ledger.begin,
            tuple(shares),
            Momenta("changed" if gifts else "kept", gifts),
        )

    def __str__(self) -> str:
        """Return the exchange in words."""
        return write("exchange", self)


def _list_shares(ledger: Ledger) -> Iterator[Share]:
    sizes = ledger.sizes
    *_, spin = PARTS
    least = ROUNDING * (sizes.weight + sizes.precession + sizes.nutation)
    for part in PARTS:
        gain = getattr(ledger.gained, part)
        # The spin is many times the rest, and so is its rounding.
        if abs(gain) > (ROUNDING * sizes.spin if part == spin else least):
            yield Share("got" if gain > 0 else "gave", part, MILLI * abs(gain))
    for cause in CAUSES:
        work = getattr(ledger, cause).work
        if abs(work) > least:
            yield Share("gave" if work > 0 else "took", cause, MILLI * abs(work))


def _list_gifts(ledger: Ledger) -> Iterator[Gift]:
    least = ROUNDING * ledger.momentum_size
    for cause in CAUSES:
        given = getattr(ledger, cause)
        amounts: dict[Momentum, float]
        amounts = {"p_phi": given.vertical_momentum, "p_psi": given.axial_momentum}
        for name, amount in amounts.items():
            if abs(amount) > least:
                yield Gift("gave" if amount > 0 else "took", cause, abs(amount), name)


def _exchange(top: Top, first: State, last: State) -> ExchangeRecord:
    """Return what the kernel finds for two states."""
    states = first, last
    orientations = np.stack([each.orientation for each in states])
    return find_exchange(
        top.moments, orientations, np.stack([each.angular_velocity for each in states])
    )


def _read_energies(record: EnergiesRecord) -> Energies:
    return Energies(record.weight, record.precession, record.nutation, record.spin)


def _list_pieces(motion: Motion, begin: float, end: float) -> list[Piece]:
    """Return what moves in a stretch between its pushes, without which there is one piece."""
    first = motion.piece_at(begin)
    pieces = [motion.piece_at(end)]
    while pieces[-1].number > first.number:
        pieces.append(motion.piece_at(ExactTimes(pieces[-1].begin - 1)))
    return pieces[::-1]


def _push(impulse: float, former: Piece, piece: Piece) -> Contribution:
    """Return what the push between two pieces gives: its work is J times the mean velocity."""
    top = piece.motion.top
    after = piece.motion.start
    before = former.motion.at(ExactTimes(piece.begin - former.begin))
    found = _exchange(top, before, after)
    change = top.angular_momentum(after) - top.angular_momentum(before)
    return Contribution(impulse * found.mean_along, impulse * found.last_sine, 0.0, change)


def _hold(top: Top, first: State, last: State, height: float) -> Contribution:
    """Return what a hand that holds phi gives: p_phi is p_psi cos(theta), and L turns with it."""
    p_psi = float(top.axial_momentum(first))
    axle = (0.0, 0.0, 1.0)
    turned = p_psi * (last.to_world(axle) - first.to_world(axle))
    return Contribution(0.0, p_psi * height, 0.0, turned)


@dataclass(frozen=True, slots=True)
class _Integrals:
    """Integrals over a stretch, by quadrature."""

    friction: Contribution = NOTHING
    torque: Contribution = NOTHING
    gravity: Real = field(default_factory=lambda: np.zeros(3))  # the torque of gravity, N m s

    def add(self, motion: Motion, begin: float, end: float) -> "_Integrals":
        """Return these with those over a part of a motion."""
        half = (end - begin) / 2
        states = motion.at(begin + half * (1 + POINTS))
        scale = half * WEIGHTS
        applied = np.broadcast_to(np.array(motion.applied_torque), (len(POINTS), 3))
        resisting = states.to_world(motion.friction.torque(states))
        return _Integrals(
            self.friction + _integrate(states, resisting, scale),
            self.torque + _integrate(states, applied, scale),
            self.gravity + scale @ motion.top.gravity_torque(states),
        )


def _integrate(states: State, torque: Real, scale: Real) -> Contribution:
    """Return what a torque (n, 3) in the world frame gives in a part."""
    power = (torque * states.to_world(states.angular_velocity)).sum(axis=-1)
    along_vertical, along_axle = torque[:, 2], states.to_body(torque)[:, 2]
    work, vertical, axial = (float(scale @ each) for each in (power, along_vertical, along_axle))
    return Contribution(work, vertical, axial, scale @ torque)


def _integrate_pieces(pieces: list[Piece], begin: float, end: float) -> _Integrals:
    """Return the integrals over a stretch that is cut where it is pushed."""
    found = _Integrals()
    starts = [begin, *(piece.begin / SECOND for piece in pieces[1:])]
    for piece, start, stop in zip(pieces, starts, [*starts[1:], end], strict=True):
        since = piece.begin / SECOND
        for part in _list_parts(piece.motion, start - since, stop - since):
            found = found.add(piece.motion, *part)
    return found


def _list_parts(motion: Motion, begin: float, end: float) -> Iterator[tuple[float, float]]:
    """Yield parts in which the integrands turn by STEP radians."""
    while begin < end:
        longest = STEP / find_fastest_rate(motion, begin)
        left = end - begin
        if left > MOST_PARTS * longest:
            wanted = f"at most {show_limit(MOST_PARTS * longest)} s after begin"
            raise refuse("end", wanted, Words(f"{show(left)} s"))
        stop = min(end, max(begin + longest, math.nextafter(begin, math.inf)))
        yield begin, stop
        begin = stop


def _find_turn(motion: Motion, t: float, half: float) -> float:
    """Return the last time up to t at which theta turns; one that rounding makes later counts.

    The rate of cos(theta) changes its sign there and nowhere else in half a nutation. Next to a
    turning point the sign is rounding, so the search begins where the rate is larger: at t or a
    quarter of a nutation before.
    """
    late = max(t, t - half / 2, key=lambda time: abs(_find_rise(motion, time)))
    early = late - half
    is_rising = _find_rise(motion, late) > 0
    for _ in range(HALVINGS):
        middle = (early + late) / 2
        if (_find_rise(motion, middle) > 0) == is_rising:
            late = middle
        else:
            early = middle
    return late + half * math.floor((t - late) / half + SLIP)


def _find_rise(motion: Motion, t: float) -> float:
    """Return the rate of cos(theta) in rad/s: of products, which the vertical has, too."""
    state = motion.at(t)
    x, y, _ = state.angular_velocity.tolist()
    up_x, up_y, _ = state.vertical.tolist()
    return float(up_x * y - up_y * x)
