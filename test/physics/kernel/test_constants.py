"""Numbers that stand in a header are those of the Python that it is a twin of."""

import importlib
import re
from decimal import Decimal, localcontext
from pathlib import Path

import pytest

from symtop_ros.physics import arguments, state, values
from symtop_ros.physics.driven import series as driven_series
from symtop_ros.physics.driven import trail as driven_trail
from symtop_ros.physics.exact import elementary, phases
from symtop_ros.physics.exact.nutation import CANCELLED, LOST_DIGITS
from symtop_ros.physics.exact.nutation_phase import NEAR_POLE
from symtop_ros.physics.exact.precise import PI_LOW, PRECISE, TWO_PI
from symtop_ros.physics.kernel import compiled

SOURCES = Path(__file__).parents[3] / "symtop_ros/physics/kernel"
DOUBLE = r"(-?0x[\da-f.]+p[+-]?\d+|-?[\d.]+(?:e[+-]?\d+)?)"
# Where a number of Python is that has another name, or is in another module than the twin.
ELSEWHERE = {
    ("precise.hpp", name): getattr(elementary, name)
    for name in ("QUARTER_HIGH", "QUARTER_LOW", "QUARTERS", "LN2_HIGH", "LN2_LOW", "DOUBLINGS")
} | {
    ("elementary.hpp", "PI"): 3.141592653589793,
    ("elementary.hpp", "PI_HIGH"): 3.141592653589793,
    ("elementary.hpp", "PI_LOW"): PI_LOW,
    ("elementary.hpp", "LEAST_EXPONENT"): elementary.LEAST_EXPONENT,
    ("elementary.hpp", "HALF_PI_HIGH"): elementary.HALF_PI_HIGH,
    ("elementary.hpp", "HALF_PI_LOW"): elementary.HALF_PI_LOW,
    ("exact/rows.hpp", "ENTRIES"): phases.ENTRIES,
    ("exact/nutation.hpp", "EPS"): values.EPS,
    ("exact/nutation.hpp", "NORM_ROUNDING"): state.NORM_ROUNDING,
    ("exact/nutation.hpp", "START_ROUNDING"): values.START_ROUNDING,
    ("exact/nutation.hpp", "PER_CANCELLED"): 1 / float(CANCELLED),
    ("exact/nutation.hpp", "LOST_BITS"): round(LOST_DIGITS * 3.3219280948873626),
    ("exact/nutation_phase.hpp", "PER_NEAR_POLE"): 1 / float(NEAR_POLE),
    ("gravity.hpp", "WEIGHTLESS"): arguments.WEIGHTLESS,
    ("driven/series.hpp", "DRIVEN_TERMS"): driven_series.TERMS,
    ("driven/motion.hpp", "MOST_DECAYS"): driven_trail.MOST_DECAYS,
    ("clock.hpp", "ELAPSED_PARTS"): compiled.PARTS,
    ("clock.hpp", "SECOND"): 10**9,
    ("symtop.cpp", "LARGEST"): values.LARGEST_MOMENT,
    ("symtop.cpp", "SMALLEST"): values.SMALLEST_MOMENT,
    ("symtop.cpp", "NORM_TOLERANCE"): state.NORM_TOLERANCE,
}
# Numbers of the kernel alone, with the reason.
OWN = {
    "LANES": "states at a time",
    "STEP_LIMBS": "256 bits",
    "MOST_MEANS": "places of an array",
    "MOST_PAIRS": "places of an array",
    "MOST_TERMS": "places of an array",
    "PARTS": "of the equations of a driven motion",
    "FACTORS": "of the equations of a driven motion",
    "KEPT": "fewer than in Python: see trail.hpp",
    "RECENT": "fewer than in Python: see trail.hpp",
    # Sums of two doubles are cheaper than extended precision in NumPy: more terms have it.
    "EXTENDED_TERMS": "more than in Python",
    "LAST": "less than in Python",
    "LARGEST_TURN": "less than in Python",
}


def list_constants():
    """File, name and value of each number that is named in the sources."""
    for path in sorted(SOURCES.rglob("*.[hc]pp")):
        file = str(path.relative_to(SOURCES))
        for line in re.findall(r"^const (?:double|int|uint64_t) (.+);", path.read_text(), re.M):
            for name, value, unit in re.findall(rf"(\w+) = {DOUBLE}( \* EPS)?(?=,|$|\s)", line):
                number = float.fromhex(value) if "0x" in value else float(value)
                yield file, name, number * values.EPS if unit else number


CONSTANTS = list(list_constants())


def find_in_python(file, name):
    if (file, name) in ELSEWHERE:
        return ELSEWHERE[file, name]
    module = importlib.import_module("symtop_ros.physics." + file[:-4].replace("/", "."))
    return getattr(module, name)


def test_the_numbers_are_found():
    assert len(CONSTANTS) > 25


@pytest.mark.parametrize(("file", "name", "value"), CONSTANTS)
def test_a_number_is_that_of_python(file, name, value):
    if name not in OWN:
        assert value == find_in_python(file, name)


def test_long_numbers_are_those_of_python():
    text = (SOURCES / "precise.hpp").read_text()
    pattern = r"const Precise (\w+) = precise\((\w+), (\w+), (\w+), (-?\d+)\)"
    with localcontext(PRECISE):
        expected = {"TWO_PI": TWO_PI, "PER_TURN": phases.PER_TURN, "LN2": Decimal(2).ln()}
        found = {
            name: Decimal(
                sum(int(limb, 16) << shift for limb, shift in zip(limbs, (128, 64, 0), strict=True))
            )
            / Decimal(2) ** (192 - int(exponent))
            for name, *limbs, exponent in re.findall(pattern, text)
        }
        assert found.keys() == expected.keys()
        for name, value in found.items():
            assert abs(value / expected[name] - 1) < Decimal("1e-48")  # some units of 50 digits


def test_the_table_of_cosines_is_that_of_python():
    text = (SOURCES / "exact/rows.hpp").read_text()
    pairs = re.findall(rf"\{{{DOUBLE}, {DOUBLE}\}}", text)
    numbers = [(float.fromhex(high), float.fromhex(low)) for high, low in pairs]
    quarter = phases.ENTRIES // 4
    assert numbers == [(row[0], row[2]) for row in phases.ROWS[: quarter + 1]]


def test_the_arc_tangents_of_eighths_are_those_of_python():
    text = (SOURCES / "elementary.hpp").read_text()
    table = text[text.index("EIGHTHS_OF_TANGENT") : text.index("HALF_PI_HIGH")]
    pairs = re.findall(rf"\{{{DOUBLE}, {DOUBLE}\}}", table)
    found = [(float.fromhex(high), float.fromhex(low)) for high, low in pairs]
    assert found == list(zip(*elementary.EIGHTHS_OF_TANGENT, strict=True))
