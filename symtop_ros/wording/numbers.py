"""Rounding: how a number is written, in every sentence.

The number is the exact value of its double. It is rounded to the nearest decimal with the given
digits; of two that are equally near the one with the even last digit is taken. A number that is
rounded to zero has no sign. Python's own formatting keeps this rule but for the sign; `toFixed` and
`toPrecision` of JavaScript round halves away from zero.

===========  ======================================================================================
format       text
===========  ======================================================================================
``3f``       3 decimals
``3g``       3 significant digits without trailing zeros, as %g of C: with an exponent of at least
             two digits if it is below -4 or not below the number of digits
``rate``     ``2f`` for zero and from 0.1 to 1e5, ``3g`` below and above
``1fdeg``    an angle in rad, written in degrees: 180/pi times the double, with 1 decimal; so with
             the other formats
===========  ======================================================================================
"""

import math

SMALLEST_RATE, LARGEST_RATE = 0.1, 1e5  # rad/s; others are written with three digits


def write_number(value: float, form: str) -> str:
    """Return a number as text.

    Parameters
    ----------
    value : float
    form : str
        A format of the table above, such as ``3f``.

    Examples
    --------
    >>> from symtop_ros.wording.numbers import write_number
    >>> write_number(0.125, "2f"), write_number(0.375, "2f"), write_number(-0.0004, "3f")
    ('0.12', '0.38', '0.000')
    >>> write_number(-49.66, "3g"), write_number(1e-5, "3g"), write_number(0.5, "1fdeg")
    ('-49.7', '1e-05', '28.6')
    """
    if form == "rate":
        plain = value == 0 or SMALLEST_RATE <= abs(value) < LARGEST_RATE
        return write_number(value, "2f" if plain else "3g")
    if form.endswith("deg"):
        return write_number(value * 180 / math.pi, form.removesuffix("deg"))
    text = f"{value:.{form}}"
    return text.lstrip("-") if float(text) == 0 else text
