"""Checks of style and types: one that cannot run has not passed."""

import pytest
from documents import ROOT
from programs import execute


@pytest.mark.parametrize("part", ["style", "types"])
def test_without_its_tools_a_check_of_the_page_fails_and_says_so(part, tmp_path):
    done = execute(["sh", ROOT / "test/check_js.sh", tmp_path, part], cwd=ROOT)
    assert done.returncode == 1
    assert "cannot be checked" in done.stdout


def test_where_the_registry_is_out_of_reach_the_tools_are_not_set_up(tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\nexit 1\n")  # pip, and then npm, find no registry
    python.chmod(0o755)
    done = execute(["sh", ROOT / "test/get_js.sh", tmp_path / "js", python], cwd=ROOT)
    assert done.returncode == 1
