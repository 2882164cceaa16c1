"""Units that people type, for `top_ctl` and the page: names, each in that of SI.

The page has them as `page/web/js/words/units.js`, which `python -m workshop.twins` writes.
"""

import math
import re

from symtop_ros.base.refusals import RefusedError, plain, refuse

DEGREE = math.pi / 180
# By the unit of SI, which comes first in each.
UNITS: dict[str, dict[str, float]] = {
    "rad": {"rad": 1.0, "°": DEGREE, "deg": DEGREE, "degrees": DEGREE},
    "rad/s": {
        "rad/s": 1.0,
        "°/s": DEGREE,
        "deg/s": DEGREE,
        "rpm": math.pi / 30,
        "rev/s": 2 * math.pi,
    },
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "kg": {"kg": 1.0, "g": 1e-3},
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "kg m^2": {"kg m^2": 1.0, "g cm^2": 1e-7},
    "J": {"J": 1.0, "mJ": 1e-3, "N m": 1.0},
    "N m s": {"N m s": 1.0},
    "1/s": {"1/s": 1.0},
    "1/s^2": {"1/s^2": 1.0},
    "m/s^2": {"m/s^2": 1.0},
}
# What a name has, wherever it is typed.
QUANTITIES = {
    **dict.fromkeys(("theta", "phi", "psi", "dip"), "rad"),
    **dict.fromkeys(("theta_dot", "phi_dot", "psi_dot"), "rad/s"),
    **dict.fromkeys(("precession_rate", "precession_rate_change"), "rad/s"),
    **dict.fromkeys(("precession_period", "nutation_period", "duration"), "s"),
    "energy": "J",
    **dict.fromkeys(("p_phi", "p_psi"), "N m s"),
    "alpha": "1/s^2",
    **dict.fromkeys(("a", "b"), "1/s"),
    "gravity": "m/s^2",
}
TYPED = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\D.*?)\s*")


def parse_quantity(name: str, text: str, unit: str) -> float:
    """Return the SI value of a number that was typed with one of its units, or without.

    Raises
    ------
    ValueError
        If it is no number, or has a unit of something else.

    Examples
    --------
    >>> parse_quantity("mass", "170g", "kg")
    0.17
    >>> parse_quantity("distance", "-25.3 cm", "m")
    -0.253
    >>> parse_quantity("mass", "9 rpm", "kg")
    Traceback (most recent call last):
    symtop_ros.base.refusals.RefusedError: mass must be a number in kg or g, got '9 rpm'
    """
    units = UNITS[unit]
    try:
        return float(plain(text))
    except ValueError:
        found = TYPED.fullmatch(text)
    if not found or found[2] not in units:
        raise refuse(name, f"a number in {_list(units)}", text)
    # In one rounding where it can be: 5.5 cm is 5.5/100 m, not 5.5 times a rounded hundredth.
    size = units[found[2]]
    return float(found[1]) * size if size >= 1 or 1 / size % 1 else float(found[1]) / (1 / size)


LITERAL = re.compile(r"[-+]?(\d*)(?:\.(\d*))?(?:[eE]([-+]?\d+))?((?![\d.]).*)?", re.DOTALL)


def halve_last_digit(text: str) -> str:
    """Return half a unit of the last digit of a typed number, with the same unit.

    Empty if it is no such number.

    Examples
    --------
    >>> halve_last_digit("57.6 s"), halve_last_digit("-3.20e2rpm"), halve_last_digit("45deg")
    ('5e-2 s', '5e-1rpm', '5e-1deg')
    """
    found = LITERAL.fullmatch(text.strip())
    if not found or not (found[1] or found[2]):
        return ""
    exponent = int(found[3] or 0) - len(found[2] or "") - 1
    return f"5e{exponent}{found[4] or ''}"


def _list(units: dict[str, float]) -> str:
    *first, last = units
    return f"{', '.join(first)} or {last}" if first else last


def read_value(name: str, text: str) -> float | str:
    """Return the number of a quantity that has a known name; other texts are returned unchanged."""
    unit = QUANTITIES.get(name)
    try:
        return float(plain(text)) if unit is None else parse_quantity(name, text, unit)
    except RefusedError:
        raise
    except ValueError:
        return text
