"""Templates: how a record becomes text.

A template has placeholders, `{name}` or `{name:form}`; `name` is a field of the record.
`{a,b:form}` stands for the numbers of several fields.

===================  =======================================================================
value of the field   text
===================  =======================================================================
none                 nothing
a number             by `form`, as below; or the template `form`, filled with it as ``{0}``;
                     `form.once` for 1; in the page `form.few` and its like by the plural
                     rules of a language that has such forms
a word, true, false  the template `form.WORD`, filled with the same record; without `form`
                     the word itself, as for a path
a record             the template `form`, or `name` without it; if the record has a field
                     `kind`, the template `form.KIND`
several of these     each as above, joined by the template `form.join`, or by `join`
some numbers         if there is a template `form`: it, with the placeholders `{0}`, `{1}`
                     ..., with as many digits as tell the numbers apart; or the template
                     `form.same`, if there is one and all read the same
===================  =======================================================================

A placeholder without text takes the space before it along. A variant (`degrees`) of a template has
the key `KEY@VARIANT`.

The number is the exact value of its double. It is rounded to the nearest decimal with the given
digits; of two that are equally near the one with the even last digit is taken. Only zero reads as
zero: a number with fewer decimals than it takes to see it is written with significant digits. Zero
has no sign. Python's own formatting keeps the first rule alone; `toFixed` and `toPrecision` of
JavaScript round halves away from zero.

===========  ======================================================================================
form         text
===========  ======================================================================================
``3f``       3 decimals, or ``3g`` if all of them would be zeros
``3g``       3 significant digits without trailing zeros, as %g of C: with an exponent of at least
             two digits if it is below -4 or not below the number of digits
``2r``       a rate: ``2f`` for zero and from 0.1 to 1e5, ``3g`` below and above
``1fdeg``    an angle in rad, written in degrees: 180/pi times the double, with 1 decimal; so with
             the other forms
``3to7f``    of some numbers: ``3f``, or ``4f`` ... ``7f`` if these make more of them differ; so
             with the other forms
===========  ======================================================================================
"""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Union

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

import math

FOLDER = Path(__file__).parent
Variant = Literal["radians", "degrees"]
PLACEHOLDER = re.compile(r"\{([\w,]+)(?::(\w+))?\}")
FORM = re.compile(r"(\d+)(?:to(\d+))?([fger])(deg)?")
MOST_DIGITS = 17  # which tell any two doubles apart
SMALLEST_RATE, LARGEST_RATE = 0.1, 1e5  # rad/s; others are written with three digits


def read_templates(name: str) -> dict[str, str]:
    """Return the templates of a language, or those that only programs use and no page."""
    return dict(json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8")))


TEMPLATES = read_templates("en") | read_templates("programs")


Record = Union["DataclassInstance", Mapping[str, Any]]


def write(name: str, record: Record, variant: Variant = "radians") -> str:
    """Return a record as text.

    Parameters
    ----------
    name : str
        Key of the template, without the kind of the record.
    record : dataclass or mapping
        The record, or its fields by their names.
    variant : {"radians", "degrees"}
        Unit of angles.

    Examples
    --------
    >>> from symtop_ros.words import write
    >>> write("pause", {"time": 0.25})
    'paused at 0.250000 s of the motion'
    """
    return _Writer(variant).write(name, record)


@dataclass(frozen=True, slots=True)
class _Writer:
    """Fills templates of one variant."""

    variant: Variant

    def write(self, name: str, record: Record) -> str:
        kind = record.get("kind") if isinstance(record, Mapping) else getattr(record, "kind", None)
        return self._fill(f"{name}.{kind}" if kind else name, record)

    def _fill(self, key: str, record: Record) -> str:
        places, end = _split(key, self.variant)
        read = record.__getitem__ if isinstance(record, Mapping) else partial(getattr, record)
        pieces = list[str]()
        for before, name, form in places:
            value = _join(map(read, name.split(","))) if "," in name else read(name)
            text = self._write_value(name, value, form, record)
            pieces += (before if text else before.removesuffix(" "), text)
        return "".join((*pieces, end))

    def _write_value(self, name: str, value: Any, form: str, record: Record) -> str:
        match value:
            case None:
                return ""
            case bool():
                return self._fill(f"{form}.{str(value).lower()}", record)
            case int() | float():
                return self._count(form, value) if form in TEMPLATES else write_number(value, form)
            case str():
                return self._fill(f"{form}.{value}", record) if form else value
            case list() | tuple():
                return self._write_several(name, value, form, record)
            case _:
                return self.write(form or name, value)

    def _write_several(self, name: str, values: Sequence[Any], form: str, record: Record) -> str:
        if form in TEMPLATES and set(map(type, values)) <= {float}:
            return self._fill_numbers(form, values)
        texts = [self._write_value(name, each, form, record) for each in values]
        return TEMPLATES.get(f"{form}.join", TEMPLATES["join"]).join(texts)

    def _count(self, form: str, value: float) -> str:
        once = f"{form}.once"
        return self._fill(once if value == 1 and once in TEMPLATES else form, {"0": value})

    def _fill_numbers(self, key: str, values: Sequence[float]) -> str:
        places, end = _split(key, self.variant)
        numbers = [(values[int(place)], form) for _, place, form in places]
        wanted = len({value for value, _ in numbers})
        texts = list[str]()
        for more in range(MOST_DIGITS):
            found = [write_number(*each, more) for each in numbers]
            if len(set(found)) > len(set(texts)):  # the shortest that tell as many apart
                texts = found
            if len(set(texts)) == wanted:
                break
        if len(set(texts)) == 1 and f"{key}.same" in TEMPLATES:
            return self._fill(f"{key}.same", {str(n): value for n, value in enumerate(values)})
        pieces = (before + text for (before, _, _), text in zip(places, texts, strict=True))
        return "".join((*pieces, end))


@lru_cache(None)
def _split(key: str, variant: Variant) -> tuple[list[tuple[str, str, str]], str]:
    """Return a template's placeholders (the text before each, name, form), and its last text."""
    *parts, end = PLACEHOLDER.split(TEMPLATES.get(f"{key}@{variant}", TEMPLATES[key]))
    forms = [form or "" for form in parts[2::3]]
    return list(zip(parts[::3], parts[1::3], forms, strict=True)), end


def _join(values: Iterable[Any]) -> list[float]:
    """Return the numbers of several fields, each a number or some."""
    return [
        number for each in values for number in (each if isinstance(each, list | tuple) else [each])
    ]


def write_number(value: float, form: str, more: int = 0) -> str:
    """Return a number as text.

    Parameters
    ----------
    value : float
    form : str
        A format of the table above, such as ``3f``.
    more : int
        Digits beyond the first number of a format such as ``3to7f``.

    Examples
    --------
    >>> from symtop_ros.words.templates import write_number
    >>> write_number(0.125, "2f"), write_number(0.375, "2f"), write_number(-0.0004, "3f")
    ('0.12', '0.38', '-0.0004')
    >>> write_number(-49.66, "3g"), write_number(1e-5, "3g"), write_number(0.5, "1fdeg")
    ('-49.7', '1e-05', '28.6')
    >>> write_number(0.5, "3to7f"), write_number(0.5, "3to7f", 2)
    ('0.500', '0.50000')
    """
    least, most, letter, degrees = _read_form(form)
    digits = min(least + more, most)
    if degrees:
        value = value * 180 / math.pi
    if letter == "r":
        plain = value == 0 or SMALLEST_RATE <= abs(value) < LARGEST_RATE
        letter, digits = ("f", digits) if plain else ("g", digits + 1)
    text = f"{value:.{digits}{letter}}"
    if value == 0:
        return text.lstrip("-")
    return text if float(text) != 0 else f"{value:.{max(digits, 1)}g}"


@lru_cache(None)
def _read_form(form: str) -> tuple[int, int, str, bool]:
    """Return least and most digits of a format, its letter, and whether it is in degrees."""
    least, most, letter, degrees = FORM.fullmatch(form).groups()  # type: ignore[union-attr]
    return int(least), int(most or least), letter, bool(degrees)
