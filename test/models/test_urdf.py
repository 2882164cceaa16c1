"""The tree of frames: what /tf and a robot_state_publisher with the URDF publish together."""

from xml.etree import ElementTree

import pytest
from physics.tops import ARTICLE
from simulation.runs import Run

from symtop_ros.models.urdf import robot_description
from symtop_ros.simulation.settings import Settings

FRAMES = [("world", "top"), ("map", "a/top"), ('w"&<', "gyro's")]


def joints(text):
    """Type, parent and child of each joint."""
    robot = ElementTree.fromstring(text)
    return [
        (each.get("type"), each.find("parent").get("link"), each.find("child").get("link"))
        for each in robot.iter("joint")
    ]


def published(text, world, top, with_tf, with_state_publisher):
    """Parent and child of each transform; robot_state_publisher leaves out floating joints."""
    own = [(world, top)] if with_tf else []
    others = [(parent, child) for kind, parent, child in joints(text) if kind != "floating"]
    return own + (others if with_state_publisher else [])


@pytest.mark.parametrize(("world", "top"), FRAMES)
@pytest.mark.parametrize("with_tf", [True, False])
@pytest.mark.parametrize("with_state_publisher", [True, False])
def test_no_frame_has_two_parents(world, top, with_tf, with_state_publisher):
    text = robot_description(ARTICLE, world, top, tf_moves_it=with_tf)
    children = [child for _, child in published(text, world, top, with_tf, with_state_publisher)]
    assert len(children) == len(set(children))


@pytest.mark.parametrize(("world", "top"), FRAMES)
@pytest.mark.parametrize(
    ("with_tf", "with_state_publisher"), [(True, True), (True, False), (False, True)]
)
def test_the_body_hangs_from_the_world(world, top, with_tf, with_state_publisher):
    text = robot_description(ARTICLE, world, top, tf_moves_it=with_tf)
    (body,) = ElementTree.fromstring(text).iterfind("link[visual]")
    parents = {
        child: parent
        for parent, child in published(text, world, top, with_tf, with_state_publisher)
    }
    frame = body.get("name")
    assert frame == top
    while frame in parents:
        frame = parents[frame]
    assert frame == world


@pytest.mark.parametrize("with_tf", [True, False])
def test_the_urdf_is_one_tree(with_tf):
    text = robot_description(ARTICLE, "world", "top", tf_moves_it=with_tf)
    links = {each.get("name") for each in ElementTree.fromstring(text).iterfind("link")}
    children = [child for _, _, child in joints(text)]
    assert links - set(children) == {"world"}
    assert sorted(children) == sorted(links - {"world"})


def test_the_top_is_described_anew_when_publish_tf_changes():
    run = Run()
    changed = {**run.simulation.settings.values, "publish_tf": False}
    run.simulation.apply_settings(Settings.from_values(changed))
    assert [each.publish_tf for each in run.sink.descriptions] == [True, False]
