"""Layers: what each folder may import."""

import ast
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "symtop_ros"
MESSAGES = (
    *("rclpy", "geometry_msgs", "sensor_msgs", "std_msgs", "std_srvs"),
    "diagnostic_msgs",
)
ARRAYS = {"numpy", "scipy", "symtop_ros.physics"}
ALLOWED = {
    "physics": ARRAYS,
    "run": {*ARRAYS, "symtop_ros.run"},
    "wire": {"numpy", "symtop_ros.wire"},
    "recording": {"mcap", "symtop_ros", "symtop_ros.recording"},
    "playback": {
        *ARRAYS,
        *("mcap", "lz4", "zstandard", "rerun", "rerun_cli"),
        *("symtop_ros.run", "symtop_ros.wire", "symtop_ros.playback"),
    },
    "report": {
        *ARRAYS,
        *("matplotlib", "pyarrow", "rerun", "tqdm"),
        *("diffrax", "exudyn", "heyoka", "jax", "mujoco", "pinocchio", "pydrake"),
        *("symtop_ros.run", "symtop_ros.playback", "symtop_ros.client", "symtop_ros.wire"),
        *("symtop_ros.report", *MESSAGES),
    },
}
FORBIDDEN = {"client": ("symtop_ros.physics",), "node": ("symtop_ros.client", "rerun")}


def imported(layer):
    """Modules that the files of a layer import, as (file, module)."""
    for path in sorted((PACKAGE / layer).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                yield from ((path.name, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                yield path.name, node.module


@pytest.mark.parametrize("layer", ALLOWED)
def test_a_layer_imports_only_what_it_may(layer):
    strangers = {
        (file, module)
        for file, module in imported(layer)
        if module.split(".")[0] not in sys.stdlib_module_names
        and not any(module == name or module.startswith(f"{name}.") for name in ALLOWED[layer])
    }
    assert strangers == set()


@pytest.mark.parametrize("layer", FORBIDDEN)
def test_a_layer_does_not_reach_across(layer):
    assert not [each for each in imported(layer) if each[1].startswith(FORBIDDEN[layer])]


def test_the_node_does_not_know_how_motion_is_computed():
    public = {"symtop_ros.physics", "symtop_ros.physics.kicks", "symtop_ros.physics.perry"}
    used = {module for _, module in imported("node") if module.startswith("symtop_ros.physics")}
    assert used <= public
