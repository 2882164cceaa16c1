"""The exchange of a stretch as a record: who gave energy and momentum, who has it, and how much.

`wording.write` makes a sentence of it. Rounding counts as nothing.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from symtop_ros.words import write

if TYPE_CHECKING:
    from symtop_ros.physics.ledger import Ledger

MILLI = 1e3
ROUNDING = 1e-12  # of the sizes at both ends: ten times the promise of states; less is rounding

Part = Literal["weight", "precession", "nutation", "spin"]
CauseName = Literal["pushes", "clamp", "friction", "torque"]
Momentum = Literal["p_phi", "p_psi"]
PARTS: tuple[Part, ...] = ("weight", "precession", "nutation", "spin")
CAUSES: tuple[CauseName, ...] = ("pushes", "clamp", "friction", "torque")


@dataclass(frozen=True, slots=True)
class Share:
    """The energy in mJ that a part gave or got, or that a cause gave or took."""

    kind: Literal["gave", "got", "took"]
    who: Part | CauseName
    amount: float


@dataclass(frozen=True, slots=True)
class Gift:
    """The momentum in N m s that a cause gave to p_phi or p_psi, or took from it."""

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
    """Exchange of a stretch: shares of energy, the givers first, or none, and momenta."""

    kind: Literal["energy", "none"]
    duration: float  # s
    shares: tuple[Share, ...]
    momenta: Momenta

    @classmethod
    def of(cls, ledger: "Ledger") -> "Exchange":
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


def _list_shares(ledger: "Ledger") -> Iterator[Share]:
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


def _list_gifts(ledger: "Ledger") -> Iterator[Gift]:
    least = ROUNDING * ledger.momentum_size
    for cause in CAUSES:
        given = getattr(ledger, cause)
        amounts: dict[Momentum, float]
        amounts = {"p_phi": given.vertical_momentum, "p_psi": given.axial_momentum}
        for name, amount in amounts.items():
            if abs(amount) > least:
                yield Gift("gave" if amount > 0 else "took", cause, abs(amount), name)
