"""Numbers and arrays: limits, and the validation of arguments.

Every refused argument raises a ValueError of one form: "NAME must be CONDITION, got VALUE".
"""

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

from symtop_ros.base.arrays import Real, Vector
from symtop_ros.base.refusals import Words, describe_range, is_real, number, refuse, require

P = ParamSpec("P")
T = TypeVar("T")

EPS = 2.0**-52  # distance from 1 to the next double
# Products of two moments, of a moment and the square of a rate, and their quotients are doubles
# within these limits.
LARGEST_ANGULAR_VELOCITY = 1e100  # rad/s
LARGEST_MOMENT, SMALLEST_MOMENT = 1e100, 1e-100  # kg m^2, or J


def validate_number(name: str, value: Any, unit: str = "") -> float:
    """Return a finite real number as a float.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : Any
        An int, a float, a NumPy number or a NumPy array without dimensions.
    unit : str
        Unit, for the message.

    Raises
    ------
    ValueError
        If the value is not a number (a bool, a string and a complex number are not), not finite,
        or too large for a double.
    """
    if _is_finite_float(value):
        return float(value)  # the common case
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    _refuse_units(name, value, unit)
    require(is_real(value), name, describe_range(-math.inf, math.inf, unit), value)
    return number(name, value, unit)


def validate_positive(name: str, value: Any, unit: str) -> float:
    """Return a number above 0, as `validate_number` does."""
    found = validate_number(name, value, unit)
    require(found > 0, name, f"> 0 {unit}", found)
    return found


def validate_array(name: str, value: Any, size: int | None = None, unit: str = "") -> Real:
    """Return finite real numbers as a new array of doubles.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : array_like (..., size) or, without a size, of any shape
        The numbers.
    size : int, optional
        Required length of the last axis.
    unit : str
        Unit, for the message.

    Raises
    ------
    ValueError
        If a value is not a number or not finite, or if the shape does not fit.
    """
    _refuse_units(name, value, unit)
    try:
        array = np.asarray(value)
        are_real = array.dtype.kind in "iuf" or all(map(is_real, array.flat))
        if _is_masked(value) or not are_real:
            raise TypeError
        array = array.astype(np.float64)  # OverflowError: an int too large for a double
    except (TypeError, ValueError, OverflowError):
        raise refuse(name, _with_unit("an array of finite numbers", unit), value) from None
    if size is not None and (array.ndim == 0 or array.shape[-1] != size):
        raise refuse(name, f"of shape (..., {size})", Words(f"shape {array.shape}"))
    # One number is the common case, and NumPy needs 2 us for the question.
    if not (np.isfinite(array).all() if array.ndim else math.isfinite(array)):
        raise refuse(name, _with_unit("an array of finite numbers", unit), Words(_find_odd(array)))
    return array


def _is_masked(value: Any) -> bool:
    """Return True for an array of numpy.ma, which NumPy 2 imports (20 ms) when it is first used."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and bool(masked.isMaskedArray(value))


def _find_odd(array: Real) -> str:
    """Return the first number that is not finite, and its place."""
    place = tuple(np.argwhere(~np.isfinite(array))[0].tolist())
    return f"{float(array[place])!r}" + (f" at {list(place)}" if place else "")


def _refuse_units(name: str, value: Any, unit: str) -> None:
    """Refuse quantities of libraries for units, which NumPy would take for plain numbers."""
    if isinstance(value, list | tuple):
        for part in value:
            _refuse_units(name, part, unit)
    elif hasattr(value, "units") or hasattr(value, "unit"):
        raise refuse(name, _with_unit("plain numbers, converted to SI units", unit), value)


def validate_numbers(name: str, value: Any, unit: str = "") -> Any:
    """Return one finite real number as a float, or many as a new array of doubles."""
    is_array = isinstance(value, list | tuple) or (
        hasattr(value, "__array__") and np.ndim(value) > 0
    )
    return (validate_array if is_array else validate_number)(name, value, unit=unit)


def validate_rate(name: str, value: Any) -> Any:
    """Return rates in rad/s as a float or an array, so small that their squares are finite."""
    rate = validate_numbers(name, value, "rad/s")
    largest = float(np.max(np.abs(rate), initial=0.0))
    if largest > LARGEST_ANGULAR_VELOCITY:
        raise refuse(name, f"at most {LARGEST_ANGULAR_VELOCITY:g} rad/s in size", largest)
    return rate


def ignore_underflow(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function so that NumPy ignores underflow in it."""

    @wraps(function)
    def compute(*arguments: P.args, **named: P.kwargs) -> T:
        with np.errstate(under="ignore"):
            return function(*arguments, **named)

    return compute


def are_floats(values: Iterable[Any]) -> bool:
    """Return True if all arguments are finite floats; may be False if their sum overflows."""
    return all(type(value) is float for value in values) and math.isfinite(sum(values))


def validate_together(values: dict[str, Any], units: Sequence[str]) -> list[Any]:
    """Return finite numbers as floats, or, if one of them is an array, as arrays of one shape.

    Parameters
    ----------
    values : dict of str to array_like (...)
        The numbers, by name.
    units : sequence of str
        Their units, for the message.

    Raises
    ------
    ValueError
        If a value is not a finite number, or if the shapes do not fit together.
    """
    if are_floats(values.values()):
        return list(values.values())
    validated = [
        validate_numbers(name, value, unit)
        for (name, value), unit in zip(values.items(), units, strict=True)
    ]
    shapes = {
        name: array.shape
        for name, array in zip(values, validated, strict=True)
        if isinstance(array, np.ndarray)
    }
    if not shapes:
        return validated
    fit_shapes(" and ".join(shapes), *shapes.values())
    spread = [array.copy() for array in np.broadcast_arrays(*validated)]
    for array in spread:
        array.flags.writeable = False
    return spread


def fit_shapes(names: str, *shapes: tuple[int, ...], listed: str = "") -> tuple[int, ...]:
    """Return the shape to which arguments are broadcast together.

    Parameters
    ----------
    names : str
        Names of the arguments, for the message.
    shapes : tuples of int
        Their shapes.
    listed : str
        The shapes in words, for the message; by default those of the tuples.

    Raises
    ------
    ValueError
        If the shapes do not fit together.
    """
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        text = listed or ", ".join(map(str, shapes))
        raise refuse(names, "of shapes that fit together", Words(text)) from None


def validate_one(given: Any, name: str = "top", kind: str = "", instead: str = "") -> None:
    """Refuse an array of tops, states or motions if a single one is required.

    Parameters
    ----------
    given : Any
        A top, a friction, a state or a motion, or many of them.
    name, kind : str
        Name of the argument, and what it is, if that is another word.
    instead : str
        What takes many, for the message.

    Raises
    ------
    ValueError
        If there are many.
    """
    if shape := getattr(given, "shape", ()):
        what = kind or name
        raise refuse(name, f"one {what}{instead}", Words(f"{what}s of shape {shape}"))


def validate_vector(name: str, value: Any, unit: str) -> Vector:
    """Return three finite numbers as floats.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : array_like (3,)
        The components.
    unit : str
        Unit and frame, for the message.

    Raises
    ------
    ValueError
        If there are not exactly three finite numbers.
    """
    if type(value) is tuple and len(value) == 3 and all(map(_is_finite_float, value)):
        return value  # the common case: NumPy needs 7 us
    try:
        x, y, z = validate_array(name, value, 3).tolist()
        return float(x), float(y), float(z)
    except (TypeError, ValueError):
        raise refuse(name, f"3 finite numbers ({unit})", value) from None


def validate_vectors(name: str, value: Any, unit: str) -> Any:
    """Return three finite numbers as floats, or an array (..., 3) of them."""
    is_many = np.ndim(value) > 1
    return validate_array(name, value, 3, unit) if is_many else validate_vector(name, value, unit)


def _is_finite_float(value: Any) -> bool:
    return type(value) is float and math.isfinite(value)


def _with_unit(condition: str, unit: str) -> str:
    return f"{condition} ({unit})" if unit else condition
