"""Declaration of the ROS parameters.

They are declared with dynamic typing, so that `publish_rate:=500` is accepted like `500.0`, and a
bad value is refused with the message of the package, at start-up as well as later.
"""

import difflib
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from symtop_ros.simulation.presets import load_scene, scene_names
from symtop_ros.simulation.settings import PARAMETERS, Settings
from symtop_ros.simulation.validation import reject

DEFAULT_SCENE = "cusps"
GROUPS = {name.partition(".")[0] for name in PARAMETERS if "." in name}


def declare_parameters(node: Node) -> Settings:
    """Declare all parameters with the defaults of the scene; return their values."""
    name: object = node.declare_parameter(
        "scene",
        DEFAULT_SCENE,
        _descriptor(
            "file in config/ with the defaults of all parameters",
            f"one of {', '.join(scene_names())}",
            read_only=True,
        ),
    ).value
    scene = load_scene(name)
    for key in scene:
        if key not in PARAMETERS:
            raise reject(f"parameter in scene {name}", f"one of {', '.join(PARAMETERS)}", key)
    # /tf is shared by all tops, of other names or namespaces.
    defaults = {"top_frame": node.get_fully_qualified_name().lstrip("/"), **scene}
    for key, parameter in PARAMETERS.items():
        descriptor = _descriptor(parameter.description, parameter.condition, parameter.read_only)
        node.declare_parameter(key, defaults.get(key, parameter.default), descriptor)
    _check_unknown_names(node)
    return Settings.from_values({key: _value(node, key) for key in PARAMETERS})


def _value(node: Node, name: str) -> Any:
    """Return a declared value; an empty list in a parameter file (`[]`) arrives without a value."""
    value = node.get_parameter(name).value
    default = PARAMETERS[name].default
    return default if value is None and isinstance(default, list) else value


def _check_unknown_names(node: Node) -> None:
    """Refuse unknown names in the groups of this node, and warn about others.

    A parameter file for /** holds the parameters of other nodes too.
    """
    known = [*PARAMETERS, "scene", "use_sim_time"]
    for name in node._parameter_overrides:
        if name in known or name.startswith("qos_overrides."):
            continue
        nearest = difflib.get_close_matches(name, known, n=1, cutoff=0.0)[0]
        if name.partition(".")[0] in GROUPS:
            raise reject("parameter name", f"known (the nearest is {nearest})", name)
        node.get_logger().warning(
            f"parameter {name!r} is unknown and not used (nearest: {nearest})"
        )


def _descriptor(description: str, condition: str, read_only: bool) -> ParameterDescriptor:
    return ParameterDescriptor(
        description=description,
        additional_constraints=f"must be {condition}",
        read_only=read_only,
        dynamic_typing=True,
    )
