"""Launch file and layouts of viewers: they name topics, frames and parameters that there are.

launch_ros, rviz, Foxglove and PlotJuggler are not on PyPI: docs/ros.md says what was tried by hand.
"""

import json
import re
import runpy
import sys
from unittest.mock import Mock
from xml.etree import ElementTree

import pytest
import yaml
from documents import ROOT

from symtop_ros.run.simulation.settings import PARAMETERS
from symtop_ros.run.simulation.topics import TOPICS
from symtop_ros.run.wire.messages import JOINTS

CONFIG = ROOT / "config"
# The launch file remaps one, for rviz.
NAMES = {topic.resolve("/top") for topic in TOPICS.values()} | {"/robot_description"}
MODULES = ("launch", "launch.actions", "launch.substitutions")
MODULES += ("launch_ros", "launch_ros.actions", "launch_ros.substitutions")


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
    urdfs = {"/top/robot_description", "/robot_description"}
    assert {"/top/euler_angles", "/diagnostics", *urdfs} <= named

    def panels(part):
        return [part] if isinstance(part, str) else panels(part["first"]) + panels(part["second"])

    assert sorted(panels(layout["layout"])) == sorted(layout["configById"])


def test_plotjuggler_shows_topics_and_joints_that_there_are():
    tree = ElementTree.parse(CONFIG / "plotjuggler.xml")
    curves = [each.get("name") for each in tree.iter("curve")]
    assert len(curves) == len(set(curves)) == 6
    for name in curves:
        topic, part, quantity = re.fullmatch(r"(/top/[a-z_]+)/(\w+)/(\w+)", name).groups()
        assert topic in NAMES
        joint = part in JOINTS and quantity in ("position", "velocity")
        assert joint or (part == "vector" and quantity in "xyz")


class Argument:
    """An argument of a launch, with the value that is given or the default."""

    def __init__(self, name):
        self._name = name

    def perform(self, values):
        return values[self._name]


@pytest.fixture
def launch(monkeypatch):
    """Return what the launch file starts for some arguments: nodes by their executables."""
    modules = {name: Mock() for name in MODULES}
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    modules["launch.substitutions"].LaunchConfiguration = Argument
    modules["launch.substitutions"].PathJoinSubstitution = list
    modules["launch_ros.actions"].Node = dict
    file = runpy.run_path(str(ROOT / "launch" / "top.launch.py"))
    file["generate_launch_description"]()
    modules["launch.actions"].OpaqueFunction.assert_called_once_with(function=file["start"])
    declared = modules["launch.actions"].DeclareLaunchArgument.call_args_list
    defaults = {each.args[0]: each.kwargs["default_value"] for each in declared}

    def run(**given):
        assert given.keys() <= defaults.keys()
        return {node["executable"]: node for node in file["start"]({**defaults, **given})}

    return run


def test_a_launch_without_arguments_starts_a_node_that_decides_all(launch):
    nodes = launch()
    assert list(nodes) == ["top_node"]
    node = nodes["top_node"]
    assert (node["name"], node["namespace"], node["parameters"]) == ("top", "", [])


def test_a_launch_publishes_the_urdf_where_rviz_looks_for_it(launch):
    assert launch()["top_node"]["remappings"] == [("~/robot_description", "robot_description")]
    assert launch(robot_description="false")["top_node"]["remappings"] == []


def test_a_launch_sets_parameters_that_there_are_after_those_of_the_file(launch):
    place = {"name": "disc", "namespace": "lab", "scene": "disc", "params_file": "mine.yaml"}
    clock = {"use_sim_time": "true", "publish_clock": "false", "start_paused": "true"}
    node = launch(**place, **clock, record="true", record_directory="here")["top_node"]
    assert (node["name"], node["namespace"]) == ("disc", "lab")
    file, given = node["parameters"]
    assert file == "mine.yaml"
    switches = {"use_sim_time": True, "publish_clock": False, "record.enabled": True}
    switches["start_paused"] = True
    assert given == {"scene": "disc", "record.directory": "here", **switches}
    assert set(given) <= {*PARAMETERS, "scene", "use_sim_time"}


@pytest.mark.parametrize(
    ("namespace", "name"), [("", "/top"), ("lab", "/lab/top"), ("/a/", "/a/top")]
)
def test_a_launch_starts_viewers_of_the_node(launch, namespace, name):
    nodes = launch(rviz="true", live="true", namespace=namespace)
    # rviz2 may not be installed: what comes after it is then not started
    assert list(nodes) == ["rviz2", "top_node", "top_live"]
    assert nodes["top_node"]["parameters"] == [{"publish_markers": True}]
    assert nodes["top_live"]["arguments"] == ["--node", name]
    for program in ("top_node", "top_live"):
        assert (ROOT / "resource" / program).is_file()
    _, folder, layout = nodes["rviz2"]["arguments"][1]
    assert (ROOT / folder / layout).is_file()
