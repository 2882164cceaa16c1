"""`colcon test` where only what package.xml declares is installed, as on Ubuntu 24.04."""

import os
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from conftest import UNDECLARED
from documents import ROOT
from programs import execute

UBUNTU = Path(sys.prefix, "ubuntu", "bin", "python")
# A plugin of pytest without which modules would be found that only `make test` installs.
HIDE = f"""
import sys

class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {UNDECLARED}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Hidden())
"""
# Files that need nothing else, files that cannot be imported, and one that finds no browser.
SOME = ("test/run/wire", "test/run/check", "test/replay/view", "test/page/web/test_page_sizes.py")
ALL = ("--collect-only", "test")


@pytest.mark.long
@pytest.mark.parametrize(("words", "missing"), [(SOME, ["mcap"]), (ALL, ["mcap", "rosbags"])])
def test_what_can_run_is_run_and_the_rest_is_skipped_with_its_reason(words, missing, tmp_path):
    (tmp_path / "hide.py").write_text(HIDE)
    variables = {**os.environ, "PYTHONPATH": str(tmp_path)}
    # As colcon starts it, in the folder of the package.
    options = ["-p", "hide", "--tb=short", f"--junit-xml={tmp_path}/found.xml"]
    done = execute([UBUNTU, "-m", "pytest", *options, *words], cwd=ROOT, env=variables, timeout=240)
    assert done.returncode == 0, done.stdout
    assert "pytest-7.4" in done.stdout
    for name in missing:
        assert f": {name} is not installed\n" in done.stdout
    if "--collect-only" not in words:
        (suite,) = ET.parse(tmp_path / "found.xml").getroot()
        assert int(suite.get("tests")) - int(suite.get("skipped")) > 30


@pytest.mark.long
def test_a_module_that_is_missing_by_mistake_is_an_error(tmp_path):
    (tmp_path / "test_it.py").write_text("import no_such_module\n")
    done = execute([UBUNTU, "-m", "pytest", f"--rootdir={ROOT}", tmp_path], cwd=ROOT)
    assert done.returncode == 2
    assert "No module named 'no_such_module'" in done.stdout


def test_what_is_called_undeclared_is_not_declared():
    declared = (ROOT / "package.xml").read_text()
    assert not [name for name in UNDECLARED if f">python3-{name.lower()}<" in declared]
