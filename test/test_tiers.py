"""Tiers of tests: what a run has, what a named and a failed test need, and which took much CPU."""

import os
import re
import sys

import pytest
from documents import ROOT
from programs import execute

TESTS = """
import pytest

def test_quick():
    assert sum(range(3)) == 3

@pytest.mark.slow
@pytest.mark.parametrize("number", [1, pytest.param(2, marks=pytest.mark.long)])
def test_family(number):
    assert number > {least}

@pytest.mark.realtime
def test_clock():
    sum(range(30_000_000))
"""
FILE = "test_some.py"
MARKS = "".join(f"    {name}: a tier\n" for name in ("slow", "realtime", "long"))


@pytest.fixture(name="folder")
def _folder(tmp_path):
    (tmp_path / FILE).write_text(TESTS.format(least=0))
    (tmp_path / "pytest.ini").write_text(f"[pytest]\nmarkers =\n{MARKS}")
    return tmp_path


def run(folder, *words):
    """Run pytest with both plugins; return the names of tests that passed or failed, and all."""
    words = [sys.executable, "-m", "pytest", "-v", "-p", "tiers", "-p", "cpu_times", *words]
    done = execute(words, cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT / "test")})
    found = re.findall(r"::(\S+) (?:PASSED|FAILED) ", done.stdout)
    return sorted(set(found)), done


TIERS = {
    (): ["test_quick"],
    ("-m", "slow"): ["test_family[1]"],
    ("-m", "long"): ["test_family[2]"],
    ("-m", "realtime"): ["test_clock"],
    (f"{FILE}::test_clock",): ["test_clock"],
    (f"{FILE}::test_family",): ["test_family[1]", "test_family[2]"],
    ("-k", "family"): [],
}


QUICK = [*TIERS][:2]


@pytest.mark.parametrize("words", QUICK, ids=" ".join)
def test_each_test_is_of_one_tier(folder, words):
    assert run(folder, *words)[0] == TIERS[words]


@pytest.mark.slow
@pytest.mark.parametrize("words", [*TIERS][2:], ids=" ".join)
def test_each_test_is_of_one_tier_and_one_that_is_named_runs_in_any(folder, words):
    assert run(folder, *words)[0] == TIERS[words]


@pytest.mark.slow
def test_a_failed_test_of_any_tier_runs_again(folder):
    (folder / FILE).write_text(TESTS.format(least=1))
    assert run(folder, "-m", "slow")[1].returncode == 1
    assert run(folder, "--lf")[0] == ["test_family[1]"]
    (folder / FILE).write_text(TESTS.format(least=0))
    assert run(folder, "--lf")[0] == ["test_family[1]"]
    assert run(folder, "--lf")[0] == ["test_quick"]  # after no failure it runs all quick ones


def test_a_test_of_two_tiers_is_refused(folder):
    (folder / FILE).write_text(f"{TESTS.format(least=0)}\npytestmark = [pytest.mark.slow]\n")
    _, done = run(folder)
    assert "test_family[2] must be of one tier, got long and slow" in done.stderr


@pytest.mark.parametrize("processes", ["0", pytest.param("2", marks=pytest.mark.slow)])
def test_tests_that_took_much_cpu_are_named_and_pass(folder, processes):
    _, done = run(folder, "--cpu", "0.1", "-n", processes, "-m", "not long")
    assert done.returncode == 0
    assert "1 of 3 tests took more than 0.1 s of CPU" in done.stdout
    assert re.search(rf"^ *[\d.]+ s  {FILE}::test_clock$", done.stdout, re.MULTILINE)
