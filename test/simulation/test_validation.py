from symtop_ros.simulation.validation import MAX_SENTENCE, one_line


def test_lines_become_one_and_control_characters_are_escaped():
    assert one_line("a\n  b\r\n\x1b[31m\udcff") == "a b \\x1b[31m\\udcff"
    assert one_line("θ' = 0.5") == "θ' = 0.5"


def test_long_text_is_shortened_in_its_middle_and_soon():
    for text in ("x" * 10_000_000, "\x1b" * 10_000_000, "a b " * 1_000_000):
        line = one_line(f"begin {text} end")
        assert len(line) == MAX_SENTENCE
        assert line.startswith("begin ")
        assert line.endswith(" end")
        assert "..." in line
