import re
from pathlib import Path
from xml.etree import ElementTree

from symtop_ros import __version__

ROOT = Path(__file__).parents[1]
DECLARATION = (ROOT / "QUALITY_DECLARATION.md").read_text()
SETTINGS = (ROOT / "pyproject.toml").read_text()


def test_the_declared_version_is_that_of_the_package():
    assert re.findall(r"version (\d\S+\d)", DECLARATION) == [__version__]


def test_the_declared_coverage_limit_is_the_one_that_is_enforced():
    (limit,) = re.findall(r"^fail_under = (\d+)$", SETTINGS, re.MULTILINE)
    assert re.findall(r"at least (\d+) %", DECLARATION) == [limit]
    omitted = re.search(r"^omit = \[(.+?)^\]", SETTINGS, re.MULTILINE | re.DOTALL)[1]
    files = re.findall(r'"(.+?)"', omitted)
    assert files
    assert [file for file in files if f"`{Path(file).stem}`" not in DECLARATION] == []


def test_every_dependency_of_the_package_is_declared():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    needed = {each.text for each in package.iter("exec_depend")}
    section = DECLARATION.split("## Dependencies")[1].split("\n## ")[0]
    rows = [line.split("|")[1] for line in section.splitlines() if line.startswith("|")]
    assert needed <= set(re.findall(r"`(.+?)`", " ".join(rows)))


def test_make_test_runs_every_test_of_real_time():
    folders = re.search(r"^REALTIME := (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[1]
    marked = [
        path.relative_to(ROOT)
        for path in ROOT.glob("test/**/test_*.py")
        if "pytest.mark.realtime" in path.read_text() and path != Path(__file__)
    ]
    assert marked
    assert {"/".join(path.parts[:2]) for path in marked} <= set(folders.split())
