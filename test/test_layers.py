"""Layers: exactly which folders and packages each folder imports."""

import ast
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "symtop_ros"
NUMERICAL = {"numpy", "scipy"}
MCAP = {"mcap", "lz4", "zstandard"}
RERUN = {"rerun", "rerun_cli"}
# Files of the package itself.
TOP = {"__init__", "arrays", "distribution", "figures", "programs", "shutdown"}
# Folder -> (folders and files of the package, other packages). Each entry is exact: an import that
# is missing here fails, and so does an entry that is not used.
ARROWS = {
    "wording": (set(), set()),  # text from records of any kind, so it is below them
    "physics": ({"wording"}, {"numpy"}),
    "wire": (set(), {"numpy"}),
    "simulation": ({"__init__", "physics", "wire", "wording"}, {*NUMERICAL, "yaml"}),
    "log": ({"__init__", "simulation", "wire"}, {"numpy", *MCAP}),
    # the page as one file
    "web": ({"physics", "simulation", "wording"}, {"yaml"}),
    # of session what it says of a motion
    "check": (
        {"__init__", "log", "models", "physics", "session", "simulation", "wire"},
        {"numpy", "mcap"},
    ),
    # of session the log that a node would have written of a run of the page
    "playback": ({"check", "log", "physics", "session", "simulation", "web"}, {"numpy", *RERUN}),
    "session": (
        {"__init__", "log", "models", "physics", "simulation", "wire", "wording"},
        {"numpy"},
    ),
    "node": (
        {
            *("__init__", "distribution", "models", "physics", "session", "shutdown", "simulation"),
            "wire",
        },
        {
            *("numpy", "rclpy", "rcl_interfaces", "std_srvs", "simulation_interfaces"),
            *("builtin_interfaces", "geometry_msgs", "visualization_msgs"),
        },
    ),
    # of session only the table of services, which imports nothing
    "client": (
        {"session", "shutdown", "simulation"},
        {"rclpy", "rcl_interfaces", "sensor_msgs", "std_srvs"},
    ),
    "live": ({"log", "playback", "shutdown", "simulation"}, {"rclpy", "rerun"}),
    "panel": (
        # client, live and rclpy: only in bridge.py, which main.py imports for --node
        {"client", "live", "shutdown", "simulation", "web"},
        {"rclpy", "geometry_msgs"},
    ),
    "models": ({"physics", "simulation"}, set()),
    "imu": ({"log", "physics", "simulation", "wire"}, {"numpy", "yaml"}),
    "testset": (set(), {"numpy"}),
    "judge": (
        {
            *("figures", "log", "models", "physics", "shutdown", "simulation", "testset"),
            *("wire", "wording"),
        },
        {*NUMERICAL, "matplotlib", "rclpy"},
    ),
}


def imports(folder):
    """Top-level packages that the files of a folder import, own folders by their names.

    Every folder may use `arrays`.
    """
    own, others = set(), set()
    for path in sorted((PACKAGE / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            modules = []
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                modules = [node.module]
            for module in modules:
                package, _, rest = module.partition(".")
                if package == "symtop_ros":
                    own.add(rest.partition(".")[0] or "__init__")
                elif package not in {*sys.stdlib_module_names, "_typeshed"}:  # types only
                    others.add(package)
    return own - {folder, "arrays"}, others


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
        for path in sorted((PACKAGE / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(
                    "symtop_ros.physics"
                ):
                    assert node.module in public, path
