from workshop.article.claims import Claim, markdown, summarize, table

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
