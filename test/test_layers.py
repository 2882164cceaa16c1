"""Layers: exactly which folders and packages each folder imports."""

import ast
import re
import sys
from functools import cache

import pytest
from documents import ROOT

PACKAGE = ROOT / "symtop_ros"
# Files next to the packages, and what every folder may use of `base`.
TOP = {"__init__", "__main__", "programs"}
GROUND = {
    f"base/{name}"
    for name in ("arrays", "counts", "header", "measured", "progress", "refusals", "units")
}
# Packages of several folders.
DIVIDED = ("run", "ros", "page", "truth")
# Folder -> folders of the package, and files of `base` | other packages. Each entry is exact: an
# import that is missing here fails, and so does an entry that is not used.
TABLE = {
    # text from records of any kind, so it is below them
    "words": " | ",
    # flint: only in reference, cupy: only in gpu
    "physics": "base/deprecation base/missing base/one_or_many words | cupy flint numpy",
    "run/wire": " | numpy",
    "run/simulation": "__init__ physics run/wire words | numpy scipy yaml",
    "run/log": "__init__ run/simulation run/wire | lz4 mcap numpy yaml zstandard",
    "run/models": "base/command physics run/simulation | ",
    "run/session": "__init__ base/missing physics run/log run/models run/simulation run/wire words"
    " | numpy",
    # of session what it says of a motion
    "run/check": "__init__ physics run/log run/models run/session run/simulation run/wire | "
    "mcap numpy",
    # the page as one file
    "page/web": "__init__ physics run/simulation words | yaml",
    # of session the log that a node would have written of a run of the page
    "replay": "base/command page/web physics run/check run/log run/session run/simulation words | "
    "numpy rerun rerun_cli",
    "ros/node": "__init__ base/command base/shutdown physics run/session run/simulation run/wire | "
    "geometry_msgs numpy rcl_interfaces rclpy re2 simulation_interfaces std_srvs",
    # of session only the table of services, which imports nothing; physics and words only in
    # body.py and spread.py, and simulation for the names of a start
    "ros/client": "base/command base/shutdown physics run/session run/simulation run/wire words | "
    "rcl_interfaces rclpy sensor_msgs std_srvs",
    "ros/live": "base/command base/shutdown replay run/log run/simulation run/wire | rclpy rerun",
    # client, live and rclpy: only in bridge.py, which main.py imports for --node
    "page/panel": "base/command base/shutdown page/web ros/client ros/live run/simulation | "
    "geometry_msgs rclpy",
    "truth/imu": "base/command physics run/log run/simulation run/wire | numpy yaml",
    "truth/testset": "__init__ base/command physics run/models | numpy",
    # what judge and fit stand on knows neither of them
    "truth/tables": "physics | numpy scipy",
    "truth/residuals": " | numpy scipy",
    "truth/topics": "run/log run/wire truth/residuals | numpy",
    "truth/fit": "base/command base/figure_style physics run/log run/simulation run/wire "
    "truth/residuals truth/tables truth/topics words | matplotlib numpy scipy",
    # of testset the limit of errors
    "truth/judge": "base/command base/figure_style base/shutdown run/log run/simulation run/wire "
    "truth/residuals truth/tables truth/testset truth/topics words | matplotlib numpy rclpy scipy",
}
ARROWS = {k: tuple(set(part.split()) for part in v.split("|")) for k, v in TABLE.items()}


def nodes(folder):
    """Yield the nodes of the syntax of the files of a folder, each with the path."""
    for path in sorted((PACKAGE / folder).rglob("*.py")):
        yield from ((path, node) for node in read_nodes(path))


@cache
def read_nodes(path):
    return [*ast.walk(ast.parse(path.read_text()))]


def name_place(module):
    """Return the folder of a module of the package, or its file if that is in `base`."""
    first, *others = module.split(".")[1:] or ["__init__"]
    return "/".join([first, *others[:1]]) if first in (*DIVIDED, "base") else first


def imports(folder):
    """Places in the package and other packages that the files of a folder import."""
    own, others = set(), set()
    for _, node in nodes(folder):
        if not isinstance(node, ast.Import | ast.ImportFrom):
            continue
        for module in [getattr(node, "module", None) or each.name for each in node.names]:
            package = module.partition(".")[0]
            if package == "symtop_ros":
                own.add(name_place(module))
            elif package not in {*sys.stdlib_module_names, "_typeshed"}:  # types only
                others.add(package)
    return own - {folder, *GROUND}, others


def list_folders():
    """Yield the packages, and the folders of those that are divided."""
    for package in [path.parent for path in PACKAGE.glob("*/__init__.py")]:
        if package.name in DIVIDED:
            yield from (
                f"{package.name}/{path.parent.name}" for path in package.glob("*/__init__.py")
            )
        elif package.name != "base":
            yield package.name


@pytest.mark.parametrize("folder", ARROWS)
def test_a_folder_imports_exactly_what_the_table_says(folder):
    assert imports(folder) == ARROWS[folder]


def test_every_folder_is_in_the_table():
    assert {*list_folders()} == set(ARROWS)
    assert {path.stem for path in PACKAGE.glob("*.py")} == TOP


def test_the_lowest_layer_imports_no_other():
    assert imports("base")[0] <= {"__init__", *(f"base/{path.stem}" for path in nodes_of_base())}


def nodes_of_base():
    return (PACKAGE / "base").glob("*.py")


def test_the_arrows_have_no_circle():
    below = {folder: own & set(ARROWS) for folder, (own, _) in ARROWS.items()}
    while below:
        lowest = {folder for folder, others in below.items() if not others & set(below)}
        assert lowest, f"a circle among {sorted(below)}"
        below = {folder: others for folder, others in below.items() if folder not in lowest}


def list_files():
    """Return the files of the package, and which of them each file imports, for types as well."""
    paths = {name_module(path): path for path in PACKAGE.rglob("*.py")}
    found = {name: set() for name in paths}
    for name, path in paths.items():
        for node in read_nodes(path):
            if isinstance(node, ast.ImportFrom) and node.module:
                within = {f"{node.module}.{each.name}" for each in node.names} & {*paths}
                found[name] |= (within or {node.module}) & {*paths} - {name}
    return found


def name_module(path):
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    return name.removesuffix(".__init__")


def test_what_judge_and_fit_stand_on_knows_neither():
    for folder in ("truth/tables", "truth/residuals", "truth/topics"):
        assert not imports(folder)[0] & {"truth/judge", "truth/fit"}
    assert "truth/judge" not in imports("truth/fit")[0]
    assert "truth/fit" not in imports("truth/judge")[0]


def test_no_files_import_each_other_in_a_circle():
    below = list_files()
    while lowest := {name for name, others in below.items() if not others & {*below}}:
        below = {name: others for name, others in below.items() if name not in lowest}
    assert not below, sorted(below)


def test_other_folders_import_physics_by_its_public_names_only():
    public = {"symtop_ros.physics"}
    for folder in set(ARROWS) - {"physics"}:
        for path, node in nodes(folder):
            module = getattr(node, "module", None) or ""
            assert not module.startswith("symtop_ros.physics") or module in public, path


# They count, or keep what was computed; every other record stays what it was when it was made.
CHANGING = {
    "Agreement",
    "Alignment",
    "Deviation",
    "Draw",
    "RowReader",
    "Markers",
    "Missed",
    "StampRows",
    "StepBudget",
    "Tables",
    "Walk",
}


def test_records_are_frozen_but_for_those_that_count():
    found = [node for _, node in nodes("") if isinstance(node, ast.ClassDef)]
    classes = [(node.name, ast.unparse(each)) for node in found for each in node.decorator_list]
    records = [each for each in classes if each[1].startswith("dataclass")]
    assert {name for name, decorator in records if "frozen=True" not in decorator} == CHANGING


def scripts(folder):
    """Folders that the page's modules of a folder import from, types included."""
    texts = [path.read_text() for path in (PACKAGE / "page/web/js" / folder).glob("*.js")]
    return {found for text in texts for found in re.findall(r'"\.\./(\w+)/\w+\.js"', text)}


def test_what_the_page_says_does_not_import_what_it_plots():
    assert "charts" not in scripts("words")
    assert "charts" not in scripts("scene")
    assert not scripts("physics") & {"charts", "words", "controls", "scene"}
