"""Faults of the sources that the trial draws: in code, never in texts and comments."""

import ast

import pytest

from workshop import faults

TEXTS = {
    "x.py": 'def f(a):\n    """Return 1 < 2."""\n    return a + 1 if a < 2 else "3 + 4"  # 5 > 6\n',
    "x.hpp": '// 1 < 2\n#include <x.h>\nreturn a + 1; /* 3 + 4 */ say("5 < 6");\n',
    "x.js": 'const a = b + 1; // 1 < 2\nsay("3 + 4", `5 < 6`);\nfind(/7 + 8/);\n',
}
FOUND = {
    "x.py": ["+ -> -", "< -> <=", "1 -> 2", "2 -> 3"],
    "x.hpp": ["+ -> -", "1 -> 2"],
    "x.js": ["+ -> -", "1 -> 2"],
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_fault_is_put_into_code_and_not_into_texts_and_comments(name, tmp_path, monkeypatch):
    (tmp_path / name).write_text(TEXTS[name])
    monkeypatch.setattr(faults, "ROOT", tmp_path)
    found = [*faults.list_faults(name)]
    assert [f"{each.old} -> {each.new}" for each in found] == FOUND[name]
    for each in found:
        changed = each.apply(TEXTS[name])
        assert changed != TEXTS[name]
        assert each.describe().startswith(f"{name}:")


@pytest.mark.slow
def test_faults_are_drawn_again_and_those_of_python_can_be_read():
    drawn = faults.draw()
    assert drawn == faults.draw()
    assert len(drawn) == sum(faults.LANGUAGES.values())
    for fault in drawn:
        if fault.path.endswith(".py"):
            ast.parse(fault.apply((faults.ROOT / fault.path).read_text()))


def test_tests_of_a_fault_are_those_of_its_folder_or_of_the_next_one_above():
    assert faults.find_tests("symtop_ros/run/log/reader.py") == ["test/run/log"]
    assert faults.find_tests("symtop_ros/page/web/js/words/facts.js") == ["test/page/web"]
