"""/tf with the real tf2_msgs."""

import importlib

from geometry_msgs.msg import QuaternionStamped
from node.built_messages import importing
from node.running_top import stamp_of

from symtop_ros.log.writer import load_definitions


def test_tf_has_the_quaternion_of_the_topic_and_the_type_of_the_log(start_top):
    with importing("tf2_msgs"):  # which PyPI does not have
        run = start_top(arguments=["--ros-args", "-r", "__ns:=/a"])
        heard = run.collect(importlib.import_module("tf2_msgs.msg").TFMessage, "/tf")
        samples = run.collect(QuaternionStamped, "/a/top/orientation")
        run.spin_until(lambda: len(heard) > 50)
    by_stamp = {stamp_of(each): each.quaternion for each in samples}
    transforms = [each for message in heard for each in message.transforms]
    found = [each for each in transforms if stamp_of(each) in by_stamp]
    assert len(found) > 40
    for each in found:
        moved = each.transform.translation
        assert (each.header.frame_id, each.child_frame_id) == ("world", "a/top")
        assert (moved.x, moved.y, moved.z) == (0.0, 0.0, 0.0)
        assert each.transform.rotation == by_stamp[stamp_of(each)]  # bit for bit
    (publisher,) = run.top.get_publishers_info_by_topic("/tf")
    definition = load_definitions()["tf2_msgs/msg/TFMessage"]
    assert str(publisher.topic_type_hash) == definition["hash"]
