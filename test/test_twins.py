"""The twins of symtop.h are current, whole, and laid out as the compiled kernel is."""

import ctypes
import re

import pytest

from symtop_ros.physics.kernel import bindings, records
from workshop import twins
from workshop.kernel_wasm import FUNCTIONS as EXPORTED

HEADER = twins.read_header()


@pytest.mark.parametrize("path", twins.list_twins(), ids=lambda path: path.name)
def test_a_twin_is_current(path):
    """If this fails: `python -m workshop.twins`, and commit the files."""
    assert path.read_text(encoding="utf-8") == twins.list_twins()[path]


def test_every_enum_record_and_function_of_the_header_is_there():
    text = twins.HEADER.read_text(encoding="utf-8")
    assert len(HEADER.enums) == len(re.findall(r"^typedef enum", text, re.MULTILINE)) == 23
    assert len(HEADER.records) == len(re.findall(r"^typedef struct {", text, re.MULTILINE)) == 23
    own = {"make", "read", "check_arithmetic"}  # of the library alone
    assert HEADER.functions.keys() == {*EXPORTED} | own


def test_a_name_is_that_in_quotes_or_the_enumerator_in_small_letters():
    assert HEADER.enums["hold"] == ("spin_rate", "spin_momentum", None)
    assert HEADER.enums["kind"][3:5] == ("looping", "through the pole")
    assert "unknown_kind" not in HEADER.enums["kind"]
    assert HEADER.enums["rule"] == (None, "holds", "fails")


def test_statuses_have_the_numbers_of_the_compiled_kernel():
    sentences = [
        bindings.bind_functions().describe_status(k).decode()
        for k in range(len(HEADER.enums["status"]))
    ]
    assert len({*sentences}) == len(sentences)
    assert sentences[records.TOO_FAR] == "times must be within 1e15 turns of the start"
    assert (
        bindings.bind_functions()
        .describe_status(len(sentences))
        .startswith(b"status must be one of")
    )


def test_a_record_of_another_size_is_called_that():
    right = [ctypes.sizeof(record) for record in records.RECORDS]
    bindings.demand_sizes(right)
    with pytest.raises(ImportError, match=r"^RatesRecord must have the 56 bytes .* got 48: run"):
        bindings.demand_sizes([*right[:4], 56, *right[5:]])
