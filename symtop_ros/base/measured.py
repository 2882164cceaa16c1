"""Numbers with their standard deviations, as text that ends at the same decimal place."""

import math

DIGITS = 2  # of a deviation: the Guide to the Expression of Uncertainty in Measurement, 7.2.6


def write_measured(value: float, deviation: float) -> tuple[str, str]:
    """Return a value and its deviation, which has two digits; both end at the same decimal place.

    Without a deviation (zero, infinite or not a number) the value has six digits.

    Parameters
    ----------
    value : float
    deviation : float
        >= 0, in the unit of the value.

    Examples
    --------
    >>> from symtop_ros.base.measured import write_measured
    >>> write_measured(300.1234, 0.0567), write_measured(299792.0, 1234.0)
    (('300.123', '0.057'), ('299800', '1200'))
    >>> write_measured(2.0, 0.0996), write_measured(-1.2e-9, 3.4e-11)
    (('2.00', '0.10'), ('-1.200e-09', '0.034e-09'))
    >>> write_measured(0.5, 0.0)
    ('0.5', '0')
    """
    if not (0 < deviation < math.inf and math.isfinite(value)):
        return f"{value:.6g}", f"{deviation:.2g}"
    # rounding may carry: 0.0996 is 0.10
    last = _find_exponent(float(f"{deviation:.{DIGITS - 1}e}")) - (DIGITS - 1)
    first = max(_find_exponent(value), _find_exponent(deviation))
    power = first if not -5 <= first < 9 else 0  # beyond these an exponent is easier to read
    places = power - last
    texts = [_round(each, last, power, places) for each in (value, deviation)]
    end = f"e{power:+03d}" if power else ""
    return texts[0] + end, texts[1] + end


def format_measured(value: float, deviation: float | None, width: int = 0) -> str:
    """Return a value and its deviation as one text; None: there is no deviation.

    The value takes at least `width` characters, as in a column.

    Examples
    --------
    >>> from symtop_ros.base.measured import format_measured
    >>> format_measured(431.274183, 1.7e-06), format_measured(0.25, None)
    ('431.2741830 +- 0.0000017', '0.25')
    """
    number, spread = write_measured(value, deviation or 0.0)
    return f"{number:>{width}} +- {spread}" if deviation else f"{number:>{width}}"


def _find_exponent(value: float) -> int:
    return int(f"{value:e}".partition("e")[2]) if value else -999


def _round(value: float, last: int, power: int, places: int) -> str:
    """Return a number, in a power of ten, rounded to 10^last."""
    # z: a number that is rounded to zero has no sign, as in all texts
    if places >= 0:
        return f"{value / 10.0**power if power else value:z.{places}f}"
    return f"{round(value, -last):z.0f}"
