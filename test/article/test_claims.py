import pytest

from symtop_ros.physics import Top
from workshop.article.claims import Claim, markdown, summarize, table
from workshop.article.motions import HANGING_DISC, TOP, cusps, regular
from workshop.article.nutation import momentum_does_not_close
from workshop.article.retell import check_claims

TWO = [
    Claim("It is so.", "1 | 2 L_z'", holds=True, equation="a * b = c", tolerance="1e-9: it is so"),
    Claim("It is not.", "3", holds=False),
]


def test_a_table_for_a_terminal_has_equation_measurement_and_tolerance_below_each_sentence():
    assert table(TWO).splitlines() == [
        " 1  pass It is so.",
        "           a * b = c",
        "           1 | 2 L_z'",
        "           tolerance 1e-9: it is so",
        " 2  FAIL It is not.",
        "           3",
        "",
        "1 of 2 claims hold.",
    ]


def test_a_markdown_table_escapes_what_would_end_a_cell_or_begin_emphasis():
    assert markdown(TWO).splitlines()[2:] == [
        r"| 1 | It is so. | a \* b = c | 1 \| 2 L\_z' | 1e-9: it is so | pass |",
        "| 2 | It is not. |  | 3 |  | FAIL |",
        "",
        "1 of 2 claims hold.",
    ]


def test_no_claims_are_counted_as_none():
    assert summarize([]) == "0 of 0 claims hold."


@pytest.mark.parametrize(
    "top",
    [
        HANGING_DISC,
        pytest.param(Top(TOP.Ix, TOP.Iz, 0.0), marks=pytest.mark.long),
        pytest.param(Top(TOP.Ix, TOP.Iz, 20 * TOP.Mgl), marks=pytest.mark.long),
        pytest.param(Top(1e-4, 2e-4, 1e-9), marks=pytest.mark.long),
    ],
    ids=["disc", "weightless", "heavy", "flat"],
)
def test_of_another_top_claims_fail_in_words(top):
    broken = [claim for claim in check_claims(top) if not claim.holds]
    assert len(broken) > 20
    assert all(claim.sentence.endswith(".") for claim in broken)


def test_a_claim_without_a_root_says_so():
    lost = momentum_does_not_close(cusps(HANGING_DISC), regular(HANGING_DISC))
    assert (lost.holds, lost.verdict) == (False, "FAIL")
    assert lost.measured == "cannot be measured: f(a) and f(b) must have different signs"
