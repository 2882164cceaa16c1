"""Start a top: ros2 launch symtop_ros top.launch.py scene:=hurry_slow rviz:=true."""

from collections.abc import Callable

import yaml
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchContext, LaunchDescription

PACKAGE = "symtop_ros"
# The name of each argument, its default and its meaning. An empty one sets no parameter, so that
# the file of parameters, the scene or the node decides.
ARGUMENTS = (
    ("name", "top", "name of the node, and of its frame"),
    ("namespace", "", "namespace of the node; config/top.rviz shows the root namespace"),
    ("scene", "", "file in config/ with the defaults of all parameters (cusps)"),
    ("params_file", "", "file with parameters of the node; arguments given here come first"),
    ("use_sim_time", "", "true: follow /clock, that of a simulation"),
    ("publish_clock", "", "true: publish /clock, the elapsed time of the run"),
    ("start_paused", "", "true: start paused, to be stepped or resumed by request"),
    ("record", "", "true: record a log from the start"),
    ("record_directory", "", "folder of the logs (./logs)"),
    (
        "robot_description",
        "true",
        "publish the URDF as robot_description, where rviz looks for it; false: "
        "~/robot_description, next to a robot, which has its own",
    ),
    ("rviz", "false", "show the top in rviz2, with ~/markers"),
    ("live", "false", "show the top in Rerun (top_live)"),
)
SWITCHES = ("robot_description", "rviz", "live")
# The parameter that an argument sets; booleans are read as in YAML.
PARAMETERS: dict[str, tuple[str, Callable[[str], object]]] = {
    "scene": ("scene", str),
    "use_sim_time": ("use_sim_time", yaml.safe_load),
    "publish_clock": ("publish_clock", yaml.safe_load),
    "start_paused": ("start_paused", yaml.safe_load),
    "record": ("record.enabled", yaml.safe_load),
    "record_directory": ("record.directory", str),
}


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, and what is started with them."""
    arguments = (
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, default, text in ARGUMENTS
    )
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])


def start(context: LaunchContext) -> list[Node]:
    """Return the node, and the programs that show it, for the arguments of a launch."""
    values = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    remaps, rviz, live = (yaml.safe_load(values[name]) for name in SWITCHES)
    given = {
        parameter: read(values[name])
        for name, (parameter, read) in PARAMETERS.items()
        if values[name]
    }
    if rviz:
        given["publish_markers"] = True
    parameters = [each for each in (values["params_file"], given) if each]
    top = Node(
        package=PACKAGE,
        executable="top_node",
        name=values["name"],
        namespace=values["namespace"],
        parameters=parameters,
        remappings=[("~/robot_description", "robot_description")] if remaps else [],
        output="screen",
    )
    layout = PathJoinSubstitution([FindPackageShare(PACKAGE), "config", "top.rviz"])
    viewer = Node(package="rviz2", executable="rviz2", arguments=["-d", layout])
    full_name = f"{values['namespace'].rstrip('/')}/{values['name']}"
    follower = Node(
        package=PACKAGE,
        executable="top_live",
        arguments=["--node", full_name if full_name.startswith("/") else f"/{full_name}"],
        output="screen",
    )
    # rviz2 first: if it is not installed, the launch ends before it has started a node.
    return [*([viewer] if rviz else ()), top, *([follower] if live else ())]
