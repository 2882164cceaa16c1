"""The shipped message definitions, compared with ROS's generator and an independent parser."""

import json
import sys
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosidl_generator_type_description import calculate_type_hash

from symtop_ros.run.log.writer import load_definitions
from symtop_ros.run.simulation.topics import TOPICS
from workshop.definitions import TARGET, TF_MESSAGE, definitions

TYPES = sorted({topic.type for topic in TOPICS.values()})


def test_the_shipped_file_is_the_one_that_the_installed_ros_gives():
    assert json.loads(TARGET.read_text()) == definitions()


@pytest.mark.parametrize("name", TYPES)
def test_the_text_defines_the_type_and_all_its_dependencies(name):
    parsed = get_types_from_msg(load_definitions()[name]["text"], name)
    known = get_typestore(Stores.ROS2_JAZZY).fielddefs
    assert name in parsed
    for each, (_, fields) in parsed.items():
        assert fields == known[each][1], each


def installed(name):
    """Return the definition of a type in the installed ROS 2."""
    package, _, short = name.split("/")
    return json.loads(Path(sys.prefix, "share", package, "msg", f"{short}.json").read_text())


@pytest.mark.parametrize("name", [each for each in TYPES if each != TF_MESSAGE])
def test_the_hash_is_that_of_the_installed_ros(name):
    hashes = {each["type_name"]: each["hash_string"] for each in installed(name)["type_hashes"]}
    assert load_definitions()[name]["hash"] == hashes[name]


def test_the_hash_of_tf_is_the_one_ros_computes():
    inner = installed("geometry_msgs/msg/TransformStamped")["type_description_msg"]
    sequence = {"type_id": 145, "capacity": 0, "string_capacity": 0}  # of a nested type
    sequence["nested_type_name"] = inner["type_description"]["type_name"]
    field = {"name": "transforms", "type": sequence, "default_value": ""}
    others = [inner["type_description"], *inner["referenced_type_descriptions"]]
    whole = {
        "type_description": {"type_name": TF_MESSAGE, "fields": [field]},
        "referenced_type_descriptions": sorted(others, key=lambda each: each["type_name"]),
    }
    assert calculate_type_hash(whole) == load_definitions()[TF_MESSAGE]["hash"]
