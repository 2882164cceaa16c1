"""Start a top: ros2 launch symtop_ros top.launch.py scene:=hurry_slow rviz:=true."""

from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

PACKAGE = "symtop_ros"
# The name of each argument, its default and its meaning.
ARGUMENTS = (
    ("scene", "cusps", "file in config/ with the defaults of all parameters"),
    ("namespace", "", "namespace of the node; config/top.rviz shows the root namespace"),
    ("rviz", "false", "show the top in rviz2, with ~/markers"),
    ("live", "false", "show the top in Rerun (top_live)"),
    ("record", "false", "record a log from the start"),
    ("record_directory", "./logs", "folder of the logs"),
)


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, the node and what is started with it."""
    values = {name: LaunchConfiguration(name) for name, _, _ in ARGUMENTS}
    layout = PathJoinSubstitution([FindPackageShare(PACKAGE), "config", "top.rviz"])
    parameters = {
        "scene": values["scene"],
        "record.enabled": ParameterValue(values["record"], value_type=bool),
        "record.directory": values["record_directory"],
        "publish_markers": ParameterValue(values["rviz"], value_type=bool),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=text)
                for name, default, text in ARGUMENTS
            ),
            # First: if rviz2 is not installed, the launch ends before it has started a node.
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", layout],
                condition=IfCondition(values["rviz"]),
            ),
            Node(
                package=PACKAGE,
                executable="top_node",
                namespace=values["namespace"],
                parameters=[parameters],
                output="screen",
            ),
            Node(
                package=PACKAGE,
                executable="top_live",
                arguments=["--node", [values["namespace"], "/top"]],
                output="screen",
                condition=IfCondition(values["live"]),
            ),
        ]
    )
