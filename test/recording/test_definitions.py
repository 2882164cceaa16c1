"""What logs say of message types, against ROS's own generator and an independent parser."""

import json
import sys
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosidl_generator_type_description import calculate_type_hash

from symtop_ros.recording.definitions import TF_HASH, TF_MESSAGE, definition

KINDS = [
    "geometry_msgs/msg/QuaternionStamped",
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/Vector3Stamped",
    "geometry_msgs/msg/WrenchStamped",
    "sensor_msgs/msg/JointState",
    "std_msgs/msg/String",
    "diagnostic_msgs/msg/DiagnosticArray",
    "rosgraph_msgs/msg/Clock",
    TF_MESSAGE,
]


@pytest.mark.parametrize("kind", KINDS)
def test_the_text_defines_the_type_and_all_it_is_made_of(kind):
    parsed = get_types_from_msg(definition(kind).text, kind)
    known = get_typestore(Stores.ROS2_JAZZY).fielddefs
    assert kind in parsed
    for name, (_, fields) in parsed.items():
        assert fields == known[name][1], name


def description(kind):
    package, _, name = kind.split("/")
    path = Path(sys.prefix, "share", package, "msg", f"{name}.json")
    return json.loads(path.read_text())["type_description_msg"]


def test_the_hash_of_tf_is_the_one_ros_computes():
    inner = description("geometry_msgs/msg/TransformStamped")
    kind = {"type_id": 145, "capacity": 0, "string_capacity": 0}  # a sequence of a nested type
    kind["nested_type_name"] = inner["type_description"]["type_name"]
    field = {"name": "transforms", "type": kind, "default_value": ""}
    others = [inner["type_description"], *inner["referenced_type_descriptions"]]
    whole = {
        "type_description": {"type_name": TF_MESSAGE, "fields": [field]},
        "referenced_type_descriptions": sorted(others, key=lambda each: each["type_name"]),
    }
    assert calculate_type_hash(whole) == TF_HASH


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != TF_MESSAGE])
def test_other_hashes_are_those_of_the_installed_types(kind):
    assert definition(kind).type_hash == calculate_type_hash(description(kind))


def test_a_type_that_is_not_installed_is_told():
    with pytest.raises(FileNotFoundError, match="no definition of nobody_msgs/msg/None"):
        definition("nobody_msgs/msg/None")
