"""Signed permutations of a quaternion's components, by what the columns of a table hold.

There are 384 of them, or 192 pairs, as a quaternion and its negative are one attitude. Those that
are a half turn of the world or of the body alone are left to the rotations.
"""

from dataclasses import dataclass
from itertools import permutations, product
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose
from symtop_ros.words import write

COLUMNS = "wxyz"
NAMED = {"-w,x,y,z", "x,y,z,w", "x,y,z,-w"}  # conjugate, in another order, and both


@dataclass(frozen=True, slots=True)
class Permutation:
    """What the columns w, x, y, z hold: places of the components, and their signs."""

    places: tuple[int, ...]
    signs: tuple[int, ...]

    @property
    def name(self) -> str:
        """The components in the order of the columns, such as w,-x,y,z."""
        held = zip(self.signs, self.places, strict=True)
        return ",".join(f"{'-' * (sign < 0)}{COLUMNS[place]}" for sign, place in held)

    def undo(self, q: Real) -> Real:
        """Return the quaternions (..., 4) whose components are in the columns."""
        right = np.empty_like(q)
        right[..., list(self.places)] = q * np.array(self.signs, dtype=float)
        return right

    def describe(self) -> str:
        """Return the permutation in words."""
        signs = [name for name, sign in zip(COLUMNS, self.signs, strict=True) if sign < 0]
        others = [name for name in COLUMNS if name not in signs]
        parts = [*self._list_moves(), *([_describe_signs(signs)] if signs else [])]
        same = {"columns": _join(others), "many": len(others) > 1} if signs else None
        return write("change.columns", {"parts": parts, "same": same})

    def _list_moves(self) -> list[dict[str, Any]]:
        """Return the exchanges and longer cycles of columns, as records for sentences."""
        moves, seen = [], set[int]()
        for first in range(4):
            cycle = [first]
            while self.places[cycle[-1]] != first:
                cycle.append(self.places[cycle[-1]])
            if len(cycle) > 1 and first not in seen:
                names = [COLUMNS[place] for place in sorted(cycle)]
                held = [COLUMNS[self.places[place]] for place in sorted(cycle)]
                kind = "exchanged" if len(cycle) == 2 else "moved"
                moves.append({"kind": kind, "columns": _join(names), "held": ", ".join(held)})
            seen |= {*cycle}
        return moves


def _describe_signs(columns: list[str]) -> dict[str, Any]:
    return {"kind": "signs", "columns": _join(columns), "many": len(columns) > 1}


def _join(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def list_permutations() -> list[Permutation]:
    """Return one permutation of each pair: the one that changes fewer signs.

    If both change two signs, it is the one that keeps the sign in the first column. Half turns and
    permutations with a name of their own are left out.
    """
    left_out = _list_half_turns() | NAMED
    every = (Permutation(*each) for each in product(permutations(range(4)), _list_signs()))
    return [each for each in every if each.name not in left_out]


def _list_signs() -> list[tuple[int, ...]]:
    """Return one of each pair of opposite signs."""
    found = product((1, -1), repeat=4)
    return [s for s in found if sum(s) > 0 or (sum(s) == 0 and s[0] > 0)]


def _list_half_turns() -> set[str]:
    """Return the names of those that are a rotation of the world or of the body alone, or none."""
    units, found = np.eye(4), set()
    for unit in units:
        for made in (compose(unit, units), compose(units, unit)):
            places = tuple(int(place) for place in np.abs(made).argmax(axis=0))
            signs = tuple(int(made[place, k]) for k, place in enumerate(places))
            found |= {Permutation(places, each).name for each in (signs, tuple(-s for s in signs))}
    return found
