"""Floats of 57 digits, compared with Python's integers bit by bit."""

import shutil
import subprocess
from pathlib import Path

import pytest
from programs import execute

FOLDER = Path(__file__).parent
KERNEL = FOLDER.parents[2] / "symtop_ros/physics/kernel"
BITS = 192


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    if not shutil.which("g++"):
        pytest.skip("no C++ compiler")
    program = tmp_path_factory.mktemp("floats") / "floats"
    command = [
        "g++",
        "-std=c++17",
        "-O1",
        "-Wno-psabi",
        "-I",
        KERNEL,
        FOLDER / "floats.cpp",
        "-o",
        program,
    ]
    subprocess.run(command, check=True)
    return [list(read(line.split())) for line in execute([program], check=True).stdout.splitlines()]


def read(words):
    """Yield sign * mantissa as an integer, and the exponent, of each number of a line."""
    for k in range(0, len(words), 3):
        yield int(words[k]) * int(words[k + 1], 16), int(words[k + 2])


def test_a_product_has_all_of_its_bits(printed):
    assert len(printed) == 1000
    for (a, _), (b, _), (product, exponent), *_ in printed:
        # It is truncated, and two of the products of limbs are left out with what is below: each is
        # less than 2^192, which is one last bit, or two of a product that was shifted.
        assert exponent in (-1, 0)
        place = BITS + exponent
        assert 0 <= a * b - (product << place) < (3 if exponent == 0 else 5) << place


def test_sums_are_truncated_and_differences_of_one_exponent_exact(printed):
    for (a, _), (b, _), _, (total, exponent), (difference, other) in printed:
        assert exponent == 1
        assert 0 <= a + b - (total << 1) < 2
        assert abs(difference) == abs(a - b) << -other
        assert (difference > 0) == (a > b)
