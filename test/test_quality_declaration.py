import re
from pathlib import Path
from xml.etree import ElementTree

import groups
from documents import ROOT


def test_every_dependency_of_the_package_is_declared():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    needed = {each.text for each in package.iter("exec_depend")}
    declaration = (ROOT / "QUALITY_DECLARATION.md").read_text()
    assert needed <= set(re.findall(r"`(.+?)`", declaration))


def test_make_test_runs_every_test_of_real_time():
    marked = [
        path.relative_to(ROOT)
        for path in ROOT.glob("test/**/test_*.py")
        if "pytest.mark.realtime" in path.read_text() and path != Path(__file__)
    ]
    assert {"/".join(path.parts[:2]) for path in marked} <= set(groups.REALTIME)
