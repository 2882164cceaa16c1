"""Scenes: ordinary ROS parameter files in share/symtop_ros/config, chosen by name."""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from rcl_interfaces.msg import Parameter as ParameterMessage
from rclpy.parameter import parameter_dict_from_yaml_file, parameter_value_to_python

from symtop_ros.node.fields import RefusedError, refuse, shown
from symtop_ros.wire.text import one_line

LARGEST = 65_536  # bytes of a scene; ours have less than one thousand
DEEPEST = 8  # levels of one; ours have four


def scene_folder() -> Path:
    """Return the folder of the scenes: of a workspace, a source tree or a Python environment."""
    here = Path("share", "symtop_ros", "config")
    folders = [Path(__file__).resolve().parents[2] / "config", Path(sys.prefix) / here]
    with suppress(PackageNotFoundError, OSError, ValueError):
        folders.insert(0, Path(get_package_share_directory("symtop_ros")) / "config")
    return next((folder for folder in folders if folder.is_dir()), folders[-1])


def scene_names() -> tuple[str, ...]:
    """Return the names of the scenes."""
    return tuple(sorted(path.stem for path in scene_folder().glob("*.yaml")))


def scene_values(name: object) -> dict[str, Any]:
    """Return the parameters that a scene sets, by name.

    Raises
    ------
    RefusedError
        Where there is no such scene, or its file cannot be read.
    """
    names = scene_names()
    if name not in names:
        raise refuse("scene", name, f"one of {', '.join(names)}")
    path = scene_folder() / f"{name}.yaml"
    try:
        _refuse_bombs(path)
        messages = parameter_dict_from_yaml_file(str(path), use_wildcard=True)
    except Exception as error:
        msg = f"scene: {path.name} is not a ROS parameter file ({one_line(error)})"
        raise RefusedError(msg) from None
    return {key: _value(key, message) for key, message in messages.items()}


def _refuse_bombs(path: Path) -> None:
    """Refuse what may grow without bound when it is read; ROS itself has no aliases in YAML."""
    if not path.is_file():
        msg = "no file"
        raise ValueError(msg)
    if path.stat().st_size > LARGEST:
        msg = f"{path.stat().st_size} bytes, allowed are {LARGEST}"
        raise ValueError(msg)
    depth = 0
    with path.open(encoding="utf-8") as file:
        for event in yaml.parse(file):
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > DEEPEST or isinstance(event, yaml.AliasEvent):
                msg = f"allowed are no aliases, and {DEEPEST} levels"
                raise ValueError(msg)


def _value(name: str, message: ParameterMessage) -> Any:
    """Value of a parameter; 2e-06 is a number to ROS itself, but text to PyYAML."""
    value = parameter_value_to_python(message.value)
    if not all(map(_is_of_ros, value if isinstance(value, list) else [value])):
        raise refuse(shown(name), value, "a number, a text, a truth value or a list of them")
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d+[eE][-+]?\d+", value):
        return float(value)
    return value


def _is_of_ros(value: object) -> bool:
    """Whether ROS has a type for it; PyYAML knows dates, sets and integers of any size."""
    if isinstance(value, int):
        return abs(value) < 2**63
    return isinstance(value, float | str)
