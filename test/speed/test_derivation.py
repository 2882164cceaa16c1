"""The reference, written from docs/derivation.md alone, and the kernel are the same."""

import re
from pathlib import Path

import pytest
from documents import ROOT

from symtop_ros.physics import State, Top
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import closed_form

pytestmark = pytest.mark.untraced
NAMES = "A", "B", "omega"
PAGE = ROOT / "docs/derivation.md"


def test_what_the_derivation_quotes_is_the_code_of_the_reference():
    code = dedent_lines(Path(closed_form.__file__).read_text())
    quoted = re.findall(r"^```py\n(.+?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert len(quoted) == 6
    for each in quoted:
        assert dedent_lines(each) in code


def dedent_lines(text):
    return "\n".join(line.strip() for line in text.splitlines())


def test_the_numbers_of_the_worked_example_are_those_of_the_reference():
    top = Top(0.000228, 0.0000572, 0.068)
    start = State.from_euler(theta=0.5, psi_dot=200.0)
    inputs = Inputs.of(top, start)
    motion = closed_form.ClosedForm(inputs, 30)
    nutation, factors = motion._nutation, motion._factors
    s1, s2, s3 = nutation.s
    found = {
        "a": inputs.angular_velocity[2] * inputs.Iz / inputs.Ix,
        "beta": nutation.beta,
        "a_2": -(s1 + s2 + s3),
        "a_1": s1 * s2 + s2 * s3 + s3 * s1,
        "a_0": -s1 * s2 * s3,
        "s_1": s1,
        "s_2": s2,
        "s_3": s3,
        "m": nutation.m,
        "k'": nutation.k,
        "Omega": nutation.rate,
        "K": nutation.K,
        "K'": nutation.Kc,
        "v_0": nutation.v0,
        **{f"gamma_{name}": each._gamma for name, each in zip(NAMES, factors, strict=True)},
        **{f"lambda_{name}": each.mean for name, each in zip(NAMES, factors, strict=True)},
        "dotvarphi": motion.mean_rates[0],
        "T": motion.period,
    }
    example = PAGE.read_text().partition("## A worked example")[2].partition("\n## ")[0]
    shown = re.findall(r"([\w\\']+)\}?(?:\$)? = (-?[\d.]+)", example.partition("|---")[2])
    assert [name.replace("\\", "") for name, _ in shown] == list(found)
    for (name, number), value in zip(shown, found.values(), strict=True):
        digits = len(number.partition(".")[2])
        assert abs(float(value) - float(number)) <= 0.5000001 * 10.0**-digits, name
