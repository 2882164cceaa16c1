"""Scene presets: ROS parameter files in share/symtop_ros/config, chosen by name. Needs no ROS."""

import os
import sys
from collections.abc import Iterator, Mapping
from itertools import takewhile
from pathlib import Path
from typing import Any

import yaml

from symtop_ros.base.refusals import RefusedError, list_names, one_line, refuse, show

CONFIG = Path("share", "symtop_ros", "config")
# Limits of a file that is read. YAML with aliases can grow without bound ("billion laughs"), and
# ROS's own reader does not accept aliases either.
MAX_BYTES = 65_536  # the scenes of this package have less than a thousand
MAX_DEPTH = 8  # levels; those scenes have four


def config_folder() -> Path:
    """Return the folder of the scenes in a workspace, a source tree or a Python environment."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    source = Path(__file__).resolve().parents[3]
    folders = [
        *(Path(prefix, CONFIG) for prefix in prefixes if prefix),
        # Next to an installed package such a folder belongs to another package.
        *([source / "config"] if (source / "package.xml").is_file() else []),
        Path(sys.prefix, CONFIG),
    ]
    return next((folder for folder in folders if folder.is_dir()), folders[-1])


def scene_names() -> tuple[str, ...]:
    """Return the names of all scenes."""
    return tuple(sorted(path.stem for path in config_folder().glob("*.yaml")))


def describe_scenes() -> Iterator[tuple[str, str, str]]:
    """Yield names, titles and stories of all scenes: their files begin with `# Title: story`."""
    for name in scene_names():
        text = (config_folder() / f"{name}.yaml").read_text(encoding="utf-8")
        comment = takewhile(lambda line: line.startswith("#"), text.splitlines())
        title, _, story = " ".join(line.lstrip("# ") for line in comment).partition(": ")
        yield name, title or name, story


def load_scene(name: object) -> dict[str, Any]:
    """Return the parameters that a scene sets, by their full names."""
    names = scene_names()
    if name not in names:
        raise refuse("scene", list_names(names, name), name)
    path = config_folder() / f"{name}.yaml"
    try:
        _refuse_bombs(path)
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        parameters = dict(_flatten(content["/**"]["ros__parameters"]))
    except Exception as error:
        is_empty = isinstance(error, KeyError | TypeError | AttributeError)
        cause = "no parameters" if is_empty else one_line(error)
        raise RefusedError(
            f"scene file {path.name} must be a ROS parameter file for /**, got {cause}"
        ) from None
    for key, value in parameters.items():
        if not all(map(_has_ros_type, value if isinstance(value, list) else [value])):
            raise refuse(show(key), "a number, a text, true, false, or a list of them", value)
    return parameters


def _flatten(parameters: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield nested parameters with dots in their names."""
    for key, value in parameters.items():
        if not isinstance(key, str):
            raise ValueError("a name that is not text")
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _refuse_bombs(path: Path) -> None:
    """Refuse files that could grow without bound when they are loaded."""
    if not path.is_file():
        raise ValueError("no file")
    if path.stat().st_size > MAX_BYTES:
        raise ValueError(f"{path.stat().st_size} bytes (limit {MAX_BYTES})")
    depth = 0
    with path.open(encoding="utf-8") as file:
        for event in yaml.parse(file):
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > MAX_DEPTH or isinstance(event, yaml.AliasEvent):
                raise ValueError(f"aliases or more than {MAX_DEPTH} levels")


def _has_ros_type(value: object) -> bool:
    """Return True for a value that ROS has a type for: YAML also has dates and big integers."""
    return abs(value) < 2**63 if isinstance(value, int) else isinstance(value, float | str)
