"""The twins of symtop.h and of the units, for Python and the page: python -m workshop.twins.

Enums, records and functions are defined in the header alone, units that may be typed in
base/units.py; the files that this writes say the same in other languages. A test fails if they are
not current. The name of an enumerator is that in quotes at the head of its comment ("" for one
without a name), or else its own in small letters.
"""

import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symtop_ros.base.units import QUANTITIES, UNITS

PACKAGE = Path(__file__).parents[1] / "symtop_ros"
KERNEL = PACKAGE / "physics/kernel"
HEADER = KERNEL / "symtop.h"
LIBRARY = KERNEL / "functions/library.hpp"  # what only ctypes calls
PYTHON, PAGE = KERNEL / "records.py", PACKAGE / "page/web/js/physics/records.js"
UNITS_OF_PAGE = PACKAGE / "page/web/js/words/units.js"
WIDTH = 100
NUMBERED = ("status",)  # enums that Python and the page know by their numbers
NAMELESS = re.compile("UNKNOWN_|KINDS_OF_")  # enumerators that are no names of anything
# Types of C in the languages. The page reads an `int` of a record as a flag.
CTYPES = {
    "double": "c_double",
    "int": "c_int",
    "unsigned": "c_uint",
    "unsigned char": "c_uint8",
    "size_t": "c_size_t",
    "uint8_t": "c_uint8",
    "int64_t": "c_int64",
}
IMPORTED = ("POINTER", "Structure", "c_char_p", *sorted({*CTYPES.values()}), "c_void_p")
SCRIPT = {"double": "double", "int": "flag"}

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
ENUM = re.compile(r"typedef enum \{(.*?)\} symtop_(\w+);", re.DOTALL)
QUOTED = re.compile(r'/\* ("[^"]*")')
ENUMERATOR = re.compile(r'SYMTOP_(\w+)(?: = \d+)?,?(?:\s*"([^"]*)")?')
RECORD = re.compile(r"typedef struct \{(.*?)\} symtop_(\w+);", re.DOTALL)
BITS = re.compile(r"/\* the sum of symtop_(\w+)")
FIELD = re.compile(r"(\w+) ([^;]+);\s*(?:/(\w+)/)?")  # with the enum of its bits, as left below
FUNCTION = re.compile(r"^SYMTOP_API ([\w ]+[ *]+)symtop_(\w+)\(([^)]*)\)", re.MULTILINE)
ARGUMENT = re.compile(r"(const )?([\w ]+?)\s*(\**)\s*(\w+)(?:\[\d+\])?$")


@dataclass(frozen=True)
class Field:
    """A field of a record: the C type without `symtop_`, the length of an array or 0, and an enum.

    The enum is that whose values are the bits of the field, or "".
    """

    kind: str
    name: str
    length: int
    bits: str


@dataclass(frozen=True)
class Header:
    """Enums, records and functions of the header."""

    enums: dict[str, tuple[str | None, ...]]
    records: dict[str, tuple[Field, ...]]
    functions: dict[str, tuple[str, tuple[str, ...]]]  # the types of the result and the arguments


def read_header() -> Header:
    """Read symtop.h, and what the library adds for ctypes."""
    text = HEADER.read_text(encoding="utf-8")
    enums = {name: tuple(_read_names(body, name)) for body, name in ENUM.findall(text)}
    for body, _ in ENUM.findall(text):
        for number, word in enumerate(_list_words(body)):  # the length of an array may be one
            text = text.replace(f"[{word}]", f"[{number}]")
    records = {name: tuple(_read_fields(body)) for body, name in RECORD.findall(text)}
    declared = COMMENT.sub("", text) + LIBRARY.read_text(encoding="utf-8")
    functions = {
        name: (result.strip(), tuple(each.strip() for each in given.split(",")))
        for result, name, given in FUNCTION.findall(declared)
    }
    return Header(enums, records, functions)


def _list_words(body: str) -> list[str]:
    """Return the enumerators of an enum, which have the numbers 0, 1, ... if none is given."""
    return re.findall(r"SYMTOP_\w+", COMMENT.sub("", body))


def _read_names(body: str, enum: str) -> Iterator[str | None]:
    def keep_name(comment: re.Match[str]) -> str:
        return found[1] if (found := QUOTED.match(comment[0])) else ""

    for found in ENUMERATOR.finditer(COMMENT.sub(keep_name, body)):
        word, quoted = found.groups()
        if not NAMELESS.match(word):
            own = word.removeprefix(f"{enum.upper()}_").lower()
            yield own if quoted is None else quoted or None


def _read_fields(body: str) -> Iterator[Field]:
    def keep_bits(comment: re.Match[str]) -> str:
        return f"/{found[1]}/" if (found := BITS.match(comment[0])) else ""

    for kind, names, bits in FIELD.findall(COMMENT.sub(keep_bits, body)):
        for each in names.split(","):
            name, _, length = each.strip().partition("[")
            yield Field(kind.removeprefix("symtop_"), name, int(length.rstrip("]") or 0), bits)


def write_python(header: Header) -> str:
    """Return the records for ctypes."""
    parts = [
        '"""Enums, records and functions of symtop.h, for ctypes.\n\n'
        "Written by `python -m workshop.twins`: change the header, and not this file.\n"
        '"""\n',
        _wrap("from ctypes import (", IMPORTED, ")")
        + "\nfrom typing import Any, ClassVar, Literal, get_args\n",
        *(_write_enum(*each) for each in header.enums.items()),
        *(_write_record(header, *each) for each in header.records.items()),
        "\n"
        + _wrap(
            "RECORDS: tuple[type[Structure], ...] = (", [*map(_name_record, header.records)], ")"
        ),
        _write_functions(header),
    ]
    return "\n".join(parts)


def _write_enum(enum: str, names: Sequence[str | None]) -> str:
    if enum in NUMBERED:
        numbers = "\n".join(f"{str(name).upper()} = {k}" for k, name in enumerate(names))
        return f"# symtop_{enum}\n{numbers}\n"
    title = "".join(part.title() for part in enum.split("_"))
    listed = _wrap(f"{title} = Literal[", [f'"{name}"' for name in names if name], "]")
    every = f"{enum.upper()}S: tuple[{title}, ...] = get_args({title})"
    if None in names:  # of which a type has no name
        words = [f'"{name}"' if name else "None" for name in names]
        every = _wrap(f"{enum.upper()}S: tuple[{title} | None, ...] = (", words, ")")
    return f"{listed}\n{every}\n"


def _wrap(head: str, parts: Sequence[str], tail: str, indent: str = "") -> str:
    """Return a list in one line if it fits, or else an element a line."""
    line = f"{indent}{head}{', '.join(parts)}{tail}"
    if len(line) <= WIDTH:
        return line
    inner = "".join(f"{indent}    {part},\n" for part in parts)
    return f"{indent}{head}\n{inner}{indent}{tail}"


def _name_record(name: str) -> str:
    return f"{''.join(part.title() for part in name.split('_'))}Record"


def _write_record(header: Header, name: str, fields: Sequence[Field]) -> str:
    rows = [f'("{each.name}", {_find_ctype(header, each)})' for each in fields]
    listed = _wrap("_fields_: ClassVar = [", rows, "]", indent="    ")
    return f'\nclass {_name_record(name)}(Structure):\n    """`symtop_{name}`."""\n\n{listed}\n'


def _find_ctype(header: Header, field: Field) -> str:
    if field.kind in header.records:
        one = _name_record(field.kind)
    else:
        one = "c_int" if field.kind in header.enums else CTYPES[field.kind]
    return f"{one} * {field.length}" if field.length else one


def _write_functions(header: Header) -> str:
    lines = ["\n# The result and the arguments of each; an array that is read is given as bytes."]
    lines.append("FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {")
    for name, (result, given) in header.functions.items():
        words = [_find_argument(header, each) for each in given if each != "void"]
        tail = ",)" if len(words) == 1 else ")"
        row = f'    "{name}": ({_find_result(result)}, ({", ".join(words)}{tail}),'
        if len(row) > WIDTH:
            parts = [_find_result(result), _wrap_arguments(words)]
            row = _wrap(f'"{name}": (', parts, "),", "    ")
        lines.append(row)
    return "\n".join([*lines, "}", ""])


def _wrap_arguments(words: Sequence[str]) -> str:
    """Return a tuple that stands in a separate line."""
    line = f"({', '.join(words)})"
    if len(line) + len("        ,") <= WIDTH:
        return line
    return "(\n" + "".join(f"            {word},\n" for word in words) + "        )"


def _find_result(text: str) -> str:
    pointers = {"const char*": "c_char_p", "symtop_motion*": "c_void_p"}
    return "None" if text == "void" else pointers.get(text, "c_int")


def _find_argument(header: Header, text: str) -> str:
    found = ARGUMENT.match(" ".join(text.split()))
    assert found, text
    const, kind, stars, _ = found.groups()
    kind = kind.removeprefix("symtop_")
    is_pointer = bool(stars) or text.endswith("]")
    if kind == "motion":
        return "c_void_p" if stars == "*" else "POINTER(c_void_p)"
    if const and is_pointer:
        return "c_char_p"
    field = Field(kind, "", 0, "")
    return f"POINTER({_find_ctype(header, field)})" if is_pointer else _find_ctype(header, field)


def write_page(header: Header) -> str:
    """Return the enums and the records for the page."""
    lines = [
        "// Enums and records of symtop.h, for the page.",
        "//",
        "// Written by `python -m workshop.twins`: change the header, and not this file.",
        "",
        "/** The numbers of symtop_status. @type {{[name: string]: number}} */",
        "export const STATUS = {",
        *(f"  {str(name).upper()}: {k}," for k, name in enumerate(header.enums["status"])),
        "};",
        "",
        "/** Names of the enums, in the order of the header. @type {{[list: string]: any[]}} */",
        "export const NAMES = {",
        *(_write_list(*each) for each in header.enums.items() if each[0] not in NUMBERED),
        "};",
        "",
        "/**",
        " * A type and a field in turn: a number, a record, one of a list of names, or its bits.",
        " * @type {{[record: string]: string[][]}}",
        " */",
        "export const RECORDS = {",
        *(line for each in header.records.items() for line in _write_fields(*each)),
        "};",
        "",
    ]
    return "\n".join(lines)


def _write_list(enum: str, names: Sequence[str | None]) -> str:
    words = [f'"{name}"' if name else "null" for name in names]
    line = f"  {enum}: [{', '.join(words)}],"
    if len(line) <= WIDTH:
        return line
    return f"  {enum}: [\n" + "".join(f"    {word},\n" for word in words) + "  ],"


def _write_fields(name: str, fields: Sequence[Field]) -> Iterator[str]:
    yield f"  {name}: ["
    for each in fields:
        kind = f"{each.bits} bits" if each.bits else SCRIPT.get(each.kind, each.kind)
        yield f'    ["{kind}{f" {each.length}" if each.length else ""}", "{each.name}"],'
    yield "  ],"


def write_units() -> str:
    """Return the units for the page, by the unit of SI."""
    lines = [
        "// Units that people type, each in that of SI, which comes first.",
        "//",
        "// Written by `python -m workshop.twins`: change base/units.py, and not this file.",
        "",
        "/** @type {{[unit: string]: {[name: string]: number}}} */",
        "export const UNITS = {",
        *(_write_sizes(*each) for each in UNITS.items()),
        "};",
        "",
        "/** The unit of SI of what has a name. @type {{[name: string]: string}} */",
        "export const QUANTITIES = {",
        *(f'  {name}: "{unit}",' for name, unit in QUANTITIES.items()),
        "};",
        "",
    ]
    return "\n".join(lines)


def _write_sizes(unit: str, sizes: Mapping[str, float]) -> str:
    parts = [f"{_quote(name)}: {_write_size(size)}" for name, size in sizes.items()]
    line = f"  {_quote(unit)}: {{ {', '.join(parts)} }},"
    if len(line) <= WIDTH:
        return line
    return f"  {_quote(unit)}: {{\n" + "".join(f"    {part},\n" for part in parts) + "  },"


def _write_size(size: float) -> str:
    """Return a number as JavaScript is formatted: 1, 0.5, 1e-7."""
    return repr(size).removesuffix(".0").replace("e-0", "e-")


def _quote(name: str) -> str:
    return name if name.isidentifier() else json.dumps(name, ensure_ascii=False)


def list_twins() -> dict[Path, str]:
    """Return what each of the files must contain."""
    header = read_header()
    return {
        PYTHON: write_python(header),
        PAGE: write_page(header),
        UNITS_OF_PAGE: write_units(),
    }


def main() -> int:
    """Write the files that have changed."""
    for path, text in list_twins().items():
        path.write_text(text, encoding="utf-8")
        print(f"wrote {path.relative_to(PACKAGE.parent)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
