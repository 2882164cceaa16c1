"""QUALITY_DECLARATION.md has a test for every feature there is, and names none that is not."""

import ast
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from security.policy import allowed

from symtop_ros import __version__, physics
from symtop_ros.client import main as client
from symtop_ros.live import main as live
from symtop_ros.node.parameters import DECLARATIONS
from symtop_ros.node.scene import scene_names
from symtop_ros.playback import main as playback
from symtop_ros.report import main as report

ROOT = Path(__file__).parents[1]
DECLARATION = (ROOT / "QUALITY_DECLARATION.md").read_text()
TOP = allowed()["/top/top_node"]  # compared with the graph by the tests of the policy
OF_EVERY_NODE = {
    *("/rosout", "/parameter_events"),
    *("~/describe_parameters", "~/get_parameter_types", "~/get_parameters", "~/list_parameters"),
    *("~/set_parameters", "~/set_parameters_atomically", "~/get_type_description"),
}
MAINS = {
    "top_ctl": client.main,
    "top_replay": playback.main,
    "top_live": live.main,
    "top_report": report.main,
}


def rows(heading):
    """First and second cells of the table under a heading, without its head."""
    section = re.search(rf"^#+ {heading}\n(.+?)(?=^#|\Z)", DECLARATION, re.MULTILINE | re.DOTALL)
    cells = [line.split("|") for line in section[1].splitlines() if line.startswith("|")]
    return [(first, second) for _, first, second, *_ in cells[2:]]


def code(cell):
    """What stands between backquotes."""
    return re.findall(r"`(.+?)`", cell)


def local(names):
    """Names of the node, without those that every node has."""
    return {name.replace("/top/", "~/") for name in names} - OF_EVERY_NODE


def scripts():
    return {path.name for path in (ROOT / "resource").glob("top_*")}


def options(capsys):
    """Programs with each of their options, as their helps tell them."""
    for name, main in MAINS.items():
        with pytest.raises(SystemExit):
            main(["--help"])
        for option in re.findall(r"^  (--\w+)", capsys.readouterr().out, re.MULTILINE):
            yield f"{name} {option}"


FEATURES = {
    "Topics": local(TOP.publish | TOP.subscribe),
    "Services": local(TOP.reply),
    "Parameters": {*DECLARATIONS, "scene", "use_sim_time"},
    "Scenes": set(scene_names()),
    "Commands": {f"top_ctl {name}" for name in (*client.NAMED, *client.PLAIN)}
    | {"top_ctl record", "top_ctl state", "top_ctl watch"},
    "Library": set(physics.__all__),
}


@pytest.mark.parametrize("kind", FEATURES)
def test_every_feature_is_in_its_table_and_nothing_else(kind):
    told = [name for first, _ in rows(kind) for name in code(first)]
    assert sorted(told) == sorted(FEATURES[kind])


def test_every_program_and_option_is_in_the_table(capsys):
    told = [name for first, _ in rows("Programs") for name in code(first)]
    assert sorted(told) == sorted(scripts() | set(options(capsys)))


@pytest.mark.parametrize("kind", [*FEATURES, "Programs", "Logs", "The rest"])
def test_every_row_names_a_test(kind):
    assert rows(kind)
    for first, second in rows(kind):
        assert any("::" in name for name in code(second)), first


def test_every_test_that_is_named_exists():
    named = set(re.findall(r"`(test/[\w/]+\.py)::(\w+)`", DECLARATION))
    assert len(named) == len(set(re.findall(r"`(\S+::\S+)`", DECLARATION)))
    for file, name in sorted(named):
        tree = ast.parse((ROOT / file).read_text())
        functions = {each.name for each in tree.body if isinstance(each, ast.FunctionDef)}
        assert name in functions, f"{file}::{name}"


def test_the_version_is_that_of_the_package():
    assert re.findall(r"version (\d\S+\d)", DECLARATION) == [__version__]


def test_the_limit_of_coverage_is_the_one_that_is_enforced():
    settings = (ROOT / "pyproject.toml").read_text()
    assert re.findall(r"at least (\d+) %", DECLARATION) == re.findall(
        r"^fail_under = (\d+)$", settings, re.MULTILINE
    )
    omitted = re.search(r"^omit = \[(.+?)^\]", settings, re.MULTILINE | re.DOTALL)[1]
    for path in re.findall(r'"(.+?)"', omitted):
        assert f"`{Path(path).stem}`" in DECLARATION


def test_every_dependency_is_declared():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    needed = {each.text for each in package.iter("exec_depend")}
    told = [name for first, _ in rows("Dependencies") for name in code(first)]
    assert needed <= set(told)
