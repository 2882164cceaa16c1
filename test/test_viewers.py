"""Launch file and layouts of viewers: they name topics, frames and parameters that there are.

launch_ros, rviz, Foxglove and PlotJuggler are not on PyPI: docs/ros.md says what was tried by hand.
"""

import json
import re
import runpy
import sys
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest
import yaml

from symtop_ros.simulation.settings import PARAMETERS
from symtop_ros.simulation.topics import TOPICS
from symtop_ros.wire.messages import JOINTS

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "config"
NAMES = {topic.resolve("/top") for topic in TOPICS.values()} | {"/top/markers"}
ACTIONS = ("launch", "launch.actions", "launch.conditions", "launch.substitutions")
ROS_ACTIONS = (
    "launch_ros.actions",
    "launch_ros.parameter_descriptions",
    "launch_ros.substitutions",
)


def test_rviz_shows_topics_and_a_frame_that_there_are():
    manager = yaml.safe_load((CONFIG / "top.rviz").read_text())["Visualization Manager"]
    displays = {each["Class"].rpartition("/")[2]: each for each in manager["Displays"]}
    assert {"RobotModel", "TF", "MarkerArray"} <= set(displays)
    assert displays["RobotModel"]["Description Topic"]["Value"] in NAMES
    assert displays["RobotModel"]["Description Topic"]["Durability Policy"] == "Transient Local"
    assert displays["MarkerArray"]["Topic"]["Value"] in NAMES
    assert manager["Global Options"]["Fixed Frame"] == PARAMETERS["world_frame"].default


def test_foxglove_shows_topics_that_there_are():
    layout = json.loads((CONFIG / "foxglove.json").read_text())
    text = json.dumps(layout)
    named = {each.rstrip("/") for each in re.findall(r'"(/[a-z_/]+)', text)}
    assert named <= NAMES
    assert {"/top/euler_angles", "/robot_description", "/diagnostics"} <= named

    def panels(part):
        return [part] if isinstance(part, str) else panels(part["first"]) + panels(part["second"])

    assert sorted(panels(layout["layout"])) == sorted(layout["configById"])


def test_plotjuggler_shows_topics_and_joints_that_there_are():
    curves = [
        each.get("name") for each in ElementTree.parse(CONFIG / "plotjuggler.xml").iter("curve")
    ]
    assert len(curves) == len(set(curves)) == 6
    for name in curves:
        topic, part, quantity = re.fullmatch(r"(/top/[a-z_]+)/(\w+)/(\w+)", name).groups()
        assert topic in NAMES
        joint = part in JOINTS and quantity in ("position", "velocity")
        assert joint or (part == "vector" and quantity in "xyz")


@pytest.fixture
def described(monkeypatch):
    """Return what the launch file describes: arguments, and nodes by their executables."""
    arguments, nodes = {}, {}
    for name in ("launch_ros", *ACTIONS, *ROS_ACTIONS):
        module = ModuleType(name)
        module.__getattr__ = lambda attribute: lambda *values, **_: (attribute, *values)
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setattr(
        sys.modules["launch.actions"],
        "DeclareLaunchArgument",
        lambda name, default_value, description: arguments.setdefault(name, default_value),
        raising=False,
    )
    monkeypatch.setattr(
        sys.modules["launch_ros.actions"],
        "Node",
        lambda **values: nodes.setdefault(values["executable"], values),
        raising=False,
    )
    file = runpy.run_path(str(ROOT / "launch" / "top.launch.py"))
    file["generate_launch_description"]()
    return arguments, nodes


def test_the_launch_file_starts_programs_and_sets_parameters_that_there_are(described):
    arguments, nodes = described
    assert set(nodes) == {"top_node", "top_live", "rviz2"}
    (parameters,) = nodes["top_node"]["parameters"]
    assert set(parameters) <= {*PARAMETERS, "scene"}
    assert "condition" not in nodes["top_node"]
    assert nodes["rviz2"]["condition"] == ("IfCondition", ("LaunchConfiguration", "rviz"))
    for name in ("top_node", "top_live"):
        assert (ROOT / "resource" / name).is_file()
    assert arguments["scene"] == "cusps"
    # the one that may not be installed: what comes after it is then not started
    assert next(iter(nodes)) == "rviz2"
    folder, layout = nodes["rviz2"]["arguments"][1][1][1:]
    assert (ROOT / folder / layout).is_file()
