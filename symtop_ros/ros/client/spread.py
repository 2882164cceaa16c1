"""The spread of a start: how far it moves while what was typed is off by its last digits.

The library is imported where it is needed, so that other commands start without it.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from typing import TYPE_CHECKING, Any, Literal

from symtop_ros.base.refusals import RefusedError
from symtop_ros.base.units import QUANTITIES, halve_last_digit, parse_quantity
from symtop_ros.ros.client.connection import Connection, UnreachableError

if TYPE_CHECKING:
    from symtop_ros.physics import Solution

SYMBOLS = {"theta": "theta", "theta_dot": "theta'", "phi_dot": "phi'", "psi_dot": "psi'"}


@dataclass(frozen=True, slots=True)
class Ends:
    """The least and the most of a number of a start, rounded outwards."""

    name: str
    least: str
    most: str
    unit: str


@dataclass(frozen=True, slots=True)
class Spread:
    """The numbers that move; "unknown" if there may be more or fewer starts."""

    kind: Literal["numbers", "unknown"]
    numbers: tuple[Ends, ...] = ()


def describe_spread(top: Connection, words: Sequence[str], values: Mapping[str, Any]) -> str:
    """Return a sentence on the start that was taken; empty if nothing was typed that may be off."""
    from symtop_ros.physics import Top, solve_start
    from symtop_ros.run.simulation.changes.seen import KNOWN, SOLUTION, asks_to_solve
    from symtop_ros.words import write

    if not asks_to_solve(values):
        return ""
    texts = dict(word.split("=", 1) for word in words)
    known = {name: float(value) for name, value in values.items() if name in KNOWN}
    half_widths = {name: find_half_width(name, texts[name]) for name in known}
    if not any(half_widths.values()):
        return ""
    try:
        own = json.loads(top.request("get_state")[1])["top"]
        starts = solve_start(Top(**own), half_widths=half_widths, **known)
    except (UnreachableError, RefusedError):  # the start stands: the node went, or has another top
        return ""
    taken = int(values.get(SOLUTION, 1))
    return write("spread", find_spread(starts[taken - 1])) if taken <= len(starts) else ""


def find_half_width(name: str, text: str) -> float:
    """Return half a unit of the last digit of a typed number, in SI; 0 without a last digit."""
    half = halve_last_digit(text)
    return parse_quantity(name, half, QUANTITIES[name]) if half else 0.0


def find_spread(start: "Solution") -> Spread:
    """Return how far the numbers of a start move."""
    least, most = start.least, start.most
    if least is None or most is None:
        return Spread("unknown")
    pairs = [(name, getattr(least, name), getattr(most, name)) for name in SYMBOLS]
    return Spread("numbers", tuple(make_ends(*each) for each in pairs if each[2] > each[1]))


def make_ends(name: str, least: float, most: float) -> Ends:
    """Return ends that are rounded outwards at the second digit of their distance.

    Examples
    --------
    >>> make_ends("psi_dot", 43.7349, 43.8109)
    Ends(name="psi'", least='43.734', most='43.811', unit='rad/s')
    """
    place = Decimal(1).scaleb(math.floor(math.log10(most - least)) - 1)
    low = Decimal(least).quantize(place, ROUND_FLOOR)
    high = Decimal(most).quantize(place, ROUND_CEILING)
    return Ends(SYMBOLS[name], f"{low:f}", f"{high:f}", QUANTITIES[name])
