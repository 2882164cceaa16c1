"""Layers: exactly which folders and packages each folder imports."""

import ast
import re
import sys

import pytest
from documents import ROOT

PACKAGE = ROOT / "symtop_ros"
# Files of the package itself.
TOP = {
    "__init__",
    "__main__",
    "arrays",
    "command",
    "missing",
    "programs",
    "refusals",
    "shutdown",
    "units",
}
# Folder -> folders and files of the package | other packages. Each entry is exact: an import that
# is missing here fails, and so does an entry that is not used.
TABLE = {
    # text from records of any kind, so it is below them
    "wording": " | ",
    # flint: only in reference, cupy: only in gpu
    "physics": "missing wording | cupy flint numpy",
    "wire": " | numpy",
    "simulation": "__init__ physics wire wording | numpy scipy yaml",
    "log": "__init__ simulation wire | lz4 mcap numpy zstandard",
    # the page as one file
    "web": "__init__ physics simulation wording | yaml",
    # of session what it says of a motion
    "check": "__init__ log models physics session simulation wire | mcap numpy",
    # of session the log that a node would have written of a run of the page
    "playback": "check command log physics session simulation web | numpy rerun rerun_cli",
    "session": "__init__ log missing models physics simulation wire wording | numpy",
    "node": "__init__ command physics session shutdown simulation wire | "
    "geometry_msgs numpy rcl_interfaces rclpy re2 simulation_interfaces std_srvs",
    # of session only the table of services, which imports nothing; physics only in solve.py
    "client": "command physics session shutdown wire | rcl_interfaces rclpy sensor_msgs std_srvs",
    "live": "command log playback shutdown simulation wire | rclpy rerun",
    # client, live and rclpy: only in bridge.py, which main.py imports for --node
    "panel": "client command live shutdown simulation web | geometry_msgs rclpy",
    "models": "command physics simulation | ",
    "imu": "command log physics simulation wire | numpy yaml",
    "testset": " | numpy",
    "judge": "command log models physics shutdown simulation testset wire wording | "
    "matplotlib numpy rclpy scipy",
}
ARROWS = {k: tuple(set(part.split()) for part in v.split("|")) for k, v in TABLE.items()}


def nodes(folder):
    """Yield the nodes of the syntax of the files of a folder, each with the path."""
    for path in sorted((PACKAGE / folder).rglob("*.py")):
        yield from ((path, node) for node in ast.walk(ast.parse(path.read_text())))


def imports(folder):
    """Top-level packages that the files of a folder import, own folders by their names.

    Every folder may use `arrays`, `refusals` and `units`, the ground floor.
    """
    own, others = set(), set()
    for _, node in nodes(folder):
        if not isinstance(node, ast.Import | ast.ImportFrom):
            continue
        for module in [getattr(node, "module", None) or each.name for each in node.names]:
            package, _, rest = module.partition(".")
            if package == "symtop_ros":
                own.add(rest.partition(".")[0] or "__init__")
            elif package not in {*sys.stdlib_module_names, "_typeshed"}:  # types only
                others.add(package)
    return own - {folder, "arrays", "refusals", "units"}, others


@pytest.mark.parametrize("folder", ARROWS)
def test_a_folder_imports_exactly_what_the_table_says(folder):
    assert imports(folder) == ARROWS[folder]


def test_every_folder_is_in_the_table():
    found = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").is_file()}
    assert found == set(ARROWS)
    assert {path.stem for path in PACKAGE.glob("*.py")} == TOP


def test_the_arrows_have_no_circle():
    below = {folder: own & set(ARROWS) for folder, (own, _) in ARROWS.items()}
    while below:
        lowest = {folder for folder, others in below.items() if not others & set(below)}
        assert lowest, f"a circle among {sorted(below)}"
        below = {folder: others for folder, others in below.items() if folder not in lowest}


def test_other_folders_import_physics_by_its_public_names_only():
    public = {"symtop_ros.physics"}
    for folder in set(ARROWS) - {"physics"}:
        for path, node in nodes(folder):
            module = getattr(node, "module", None) or ""
            assert not module.startswith("symtop_ros.physics") or module in public, path


# They count, or keep what was computed; every other record stays what it was when it was made.
CHANGING = {"Draw", "Markers", "Tables", "Fit", "StepBudget", "Deviation", "StampRows", "Walk"}


def test_records_are_frozen_but_for_those_that_count():
    found = [node for _, node in nodes("") if isinstance(node, ast.ClassDef)]
    classes = [(node.name, ast.unparse(each)) for node in found for each in node.decorator_list]
    records = [each for each in classes if each[1].startswith("dataclass")]
    assert {name for name, decorator in records if "frozen=True" not in decorator} == CHANGING


def scripts(folder):
    """Folders that the page's modules of a folder import from, types included."""
    texts = [path.read_text() for path in (PACKAGE / "web/js" / folder).glob("*.js")]
    return {found for text in texts for found in re.findall(r'"\.\./(\w+)/\w+\.js"', text)}


def test_what_the_page_says_does_not_import_what_it_plots():
    assert "charts" not in scripts("words")
    assert "charts" not in scripts("scene")
    assert not scripts("physics") & {"charts", "words", "controls", "scene"}
