"""Templates: how a record becomes text.

A template has placeholders, `{name}` or `{name:form}`; `name` is a field of the record.

===================  =======================================================================
value of the field   text
===================  =======================================================================
none                 nothing
a number             by `form`, see `numbers`
a word, true, false  the template `form.WORD`, filled with the same record; without `form`
                     the word itself, as for a path
a record             the template `form`, or `name` without it; if the record has a field
                     `kind`, the template `form.KIND`
several of these     each as above, joined by the template `form.join`, or by `join`
some numbers         if there is a template `form`: it, with the placeholders `{0}`, `{1}`
                     ...; or the template `form.same` if all of them read the same
===================  =======================================================================

A placeholder without text takes the space before it along. A variant (`degrees`) of a template has
the key `KEY@VARIANT`.
"""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from symtop_ros.wording.numbers import write_number

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

FILE = Path(__file__).with_name("en.json")
TEMPLATES: dict[str, str] = json.loads(FILE.read_text(encoding="utf-8"))
Variant = Literal["radians", "degrees"]
PLACEHOLDER = re.compile(r" ?\{(\w+)(?::(\w+))?\}")


def write(
    name: str, record: "DataclassInstance | Mapping[str, Any]", variant: Variant = "radians"
) -> str:
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
    >>> from symtop_ros.wording import write
    >>> write("pause", {"time": 0.25})
    'paused at 0.250000 s of the motion'
    """
    fields = record if isinstance(record, Mapping) else asdict(record)
    return _Writer(variant).write(name, fields)


@dataclass(frozen=True, slots=True)
class _Writer:
    """Fills templates of one variant."""

    variant: Variant

    def write(self, name: str, record: Mapping[str, Any]) -> str:
        kind = record.get("kind")
        return self._fill(f"{name}.{kind}" if kind else name, record)

    def _fill(self, key: str, record: Mapping[str, Any]) -> str:
        template = TEMPLATES.get(f"{key}@{self.variant}", TEMPLATES[key])

        def replace(found: "re.Match[str]") -> str:
            name, form = found.groups()
            text = self._write_value(name, record[name], form, record)
            return f" {text}" if text and found[0].startswith(" ") else text

        return PLACEHOLDER.sub(replace, template)

    def _write_value(self, name: str, value: Any, form: str, record: Mapping[str, Any]) -> str:
        if value is None:
            return ""
        if isinstance(value, bool):
            return self._fill(f"{form}.{str(value).lower()}", record)
        if isinstance(value, int | float):
            return write_number(value, form)
        if isinstance(value, str):
            return self._fill(f"{form}.{value}", record) if form else value
        if isinstance(value, Mapping):
            return self.write(form or name, value)
        return self._write_several(name, value, form, record)

    def _write_several(
        self, name: str, values: Sequence[Any], form: str, record: Mapping[str, Any]
    ) -> str:
        if form in TEMPLATES and all(isinstance(each, float) for each in values):
            return self._fill_numbers(form, values)
        texts = [self._write_value(name, each, form, record) for each in values]
        return TEMPLATES.get(f"{form}.join", TEMPLATES["join"]).join(texts)

    def _fill_numbers(self, key: str, values: Sequence[float]) -> str:
        record = {str(place): value for place, value in enumerate(values)}
        template = TEMPLATES.get(f"{key}@{self.variant}", TEMPLATES[key])
        forms = dict(PLACEHOLDER.findall(template))
        texts = {write_number(record[place], form) for place, form in forms.items()}
        return self._fill(f"{key}.same" if len(texts) == 1 else key, record)
