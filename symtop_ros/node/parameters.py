"""The parameters of the node: what each is, its default, unit and range, and which can change.

Numbers are declared with dynamic typing, so that `publish_rate:=500` is as good as `500.0` and a
bad value is refused in our own words, at start-up as well as later.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sized
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from symtop_ros.node.fields import LARGEST_RATE, RefusedError, choice, flag, number, numbers, refuse
from symtop_ros.node.initial import LARGEST_ANGLE, PRECESSIONS
from symtop_ros.node.scene import scene_values
from symtop_ros.physics import Friction, Top

Check = Callable[[str, Any], Any]
TURN = 3.141592653589793
LONGEST_FRAME = 200  # characters; it stands in every message


@dataclass(frozen=True, slots=True)
class Declaration:
    """One parameter: its default, what it means, what is allowed, and how that is checked."""

    default: Any
    description: str
    allowed: str
    check: Check
    read_only: bool = False

    def descriptor(self) -> ParameterDescriptor:
        """Return the ROS descriptor."""
        return ParameterDescriptor(
            description=self.description,
            additional_constraints=f"allowed: {self.allowed}",
            read_only=self.read_only,
            dynamic_typing=True,
        )


def _number(default: float, description: str, unit: str, low: float, high: float) -> Declaration:
    check = partial(number, low=low, high=high)
    return Declaration(
        default, f"{description} ({unit})", f"{low:.6g} ... {high:.6g} {unit}", check
    )


def _angle(name: str, low: float = -LARGEST_ANGLE, high: float = LARGEST_ANGLE) -> Declaration:
    return _number(0.0, f"initial {name}", "rad", low, high)


def _rate(description: str) -> Declaration:
    return _number(0.0, description, "rad/s", -LARGEST_RATE, LARGEST_RATE)


def _list(description: str, size: int, limit: float) -> Declaration:
    def check(name: str, value: Any) -> list[float]:
        empty = not isinstance(value, str) and isinstance(value, Sized) and len(value) == 0
        return [] if empty else list(numbers(name, value, size, limit))

    return Declaration([0.0] * 0, description, f"{size} numbers, or empty: not set", check)


def _printable(value: Any) -> bool:
    return isinstance(value, str) and bool(value.strip()) and value.isprintable()


def _frame(name: str, value: Any) -> str:
    if not _printable(value) or len(value) > LONGEST_FRAME:
        allowed = f"the name of a frame, up to {LONGEST_FRAME} printable characters"
        raise refuse(name, value, allowed)
    return str(value)


def _folder(name: str, value: Any) -> str:
    if not _printable(value):
        raise refuse(name, value, "the name of a folder, in printable characters")
    return str(value)


def _precession(name: str, value: Any) -> str:
    return choice(name, value, ("", *PRECESSIONS))


DECLARATIONS: dict[str, Declaration] = {
    "top.Ix": _number(2.28e-4, "moment of inertia across the axis", "kg m^2", 1e-30, 1e30),
    "top.Iz": _number(
        5.72e-5, "moment of inertia about the axis, at most 2 Ix", "kg m^2", 1e-30, 1e30
    ),
    "top.Mgl": _number(0.068, "weight times distance of the centre of mass", "J", -1e30, 1e30),
    "initial.theta": _angle("tilt", 0.0, TURN),
    "initial.phi": _angle("precession angle"),
    "initial.psi": _angle("spin angle"),
    "initial.theta_dot": _rate("initial rate of the tilt"),
    "initial.phi_dot": _rate("initial precession rate"),
    "initial.psi_dot": _rate("initial spin rate"),
    "initial.precession": Declaration(
        "", "start on a root of regular precession", "slow, fast, or empty: not set", _precession
    ),
    "initial.orientation": _list("initial quaternion x, y, z, w, body -> world", 4, 2.0),
    "initial.angular_velocity": _list(
        "initial angular velocity in the body frame (rad/s)", 3, LARGEST_RATE
    ),
    "friction.axial": _number(0.0, "torque over omega_z on the axis", "N m s", 0.0, 1e30),
    "friction.transverse": _number(0.0, "torque over omega across the axis", "N m s", 0.0, 1e30),
    "steady_torque": _list("torque that always acts, in the world frame (N m)", 3, 1e30),
    "applied_torque_timeout": _number(
        0.1, "how long a sample of ~/applied_torque holds", "s", 0.001, 1e6
    ),
    "hurry_factor": _number(1.4, "what hurry_precession multiplies phi' by", "1", -1e6, 1e6),
    "publish_rate": _number(200.0, "samples per second", "Hz", 1.0, 2000.0),
    "real_time_factor": _number(1.0, "seconds of motion per second", "1", 0.01, 100.0),
    "publish_tf": Declaration(True, "publish world -> top on /tf", "true or false", flag),
    "publish_clock": Declaration(False, "publish /clock", "true or false", flag, read_only=True),
    "record.enabled": Declaration(
        False, "record from the start; later by ~/record", "true or false", flag, read_only=True
    ),
    "record.directory": Declaration(
        "./logs", "folder of the logs", "a folder", _folder, read_only=True
    ),
    "record.max_size": _number(0.0, "size at which a new log begins; 0: none", "B", 0.0, 1e15),
    "record.max_duration": _number(0.0, "length at which a new log begins; 0: none", "s", 0.0, 1e9),
    "world_frame": Declaration("world", "fixed frame, z up", "a frame", _frame, read_only=True),
    "top_frame": Declaration("top", "frame of the body", "a frame", _frame, read_only=True),
}


@dataclass(frozen=True, slots=True)
class Settings:
    """All parameters, checked."""

    values: Mapping[str, Any]
    top: Top
    friction: Friction

    def __getitem__(self, name: str) -> Any:
        """Return one value by its full name."""
        return self.values[name]

    @property
    def steady_torque(self) -> tuple[float, float, float]:
        """Torque that always acts, world frame, N m."""
        x, y, z = self.values["steady_torque"] or (0.0, 0.0, 0.0)
        return x, y, z

    @property
    def initial(self) -> dict[str, Any]:
        """The `initial.*` values by their short names."""
        return {
            name.removeprefix("initial."): value
            for name, value in self.values.items()
            if name.startswith("initial.")
        }


def checked(values: Mapping[str, Any]) -> Settings:
    """Return settings from raw values; RefusedError names the first one that is not allowed."""
    clean = {name: DECLARATIONS[name].check(name, value) for name, value in values.items()}
    for name in ("orientation", "angular_velocity"):
        if bool(clean["initial.orientation"]) != bool(clean[f"initial.{name}"]):
            msg = "initial.orientation and initial.angular_velocity: allowed is both, or neither"
            raise RefusedError(msg)
    try:
        top = Top(**{field.name: clean[f"top.{field.name}"] for field in fields(Top)})
    except ValueError as error:
        msg = f"top.{error}"
        raise RefusedError(msg) from None
    friction = Friction(clean["friction.axial"], clean["friction.transverse"])
    return Settings(clean, top, friction)


def declare(node: Node) -> Settings:
    """Declare all parameters, defaults from the scene, and return what they were set to.

    Raises
    ------
    RefusedError
        Where a value, the scene or its file is not allowed.
    """
    name: object = node.declare_parameter(
        "scene",
        "cusps",
        ParameterDescriptor(
            description="scene: a file in config/ with the defaults of all parameters",
            read_only=True,
            dynamic_typing=True,
        ),
    ).value
    scene = scene_values(name)
    unknown = sorted(set(scene) - set(DECLARATIONS))
    if unknown:
        raise refuse(f"scene {name}", unknown[0], f"one of {', '.join(DECLARATIONS)}")
    for key, declaration in DECLARATIONS.items():
        node.declare_parameter(key, scene.get(key, declaration.default), declaration.descriptor())
    return checked({key: node.get_parameter(key).value for key in DECLARATIONS})
