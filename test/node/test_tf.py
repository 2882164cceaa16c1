"""/tf with the real tf2_msgs, between processes."""

import json
import sys

import pytest
from node.built_messages import with_messages
from programs import command, environment, execute, running

from symtop_ros.log.writer import load_definitions
from workshop.load.domains import claim_domain
from workshop.load.endings import bound

pytestmark = pytest.mark.untraced
DOMAIN = claim_domain()
LISTEN = """
import json, rclpy
from geometry_msgs.msg import QuaternionStamped
from tf2_msgs.msg import TFMessage

def stamp(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec

def numbers(q):
    return [q.x, q.y, q.z, q.w]

rclpy.init()
node = rclpy.create_node("listener")
transforms, samples = {}, {}

def take(message):
    for each in message.transforms:
        names = each.header.frame_id, each.child_frame_id
        moved = each.transform.translation
        zero = (moved.x, moved.y, moved.z) == (0.0, 0.0, 0.0)
        transforms[stamp(each.header)] = names, zero, numbers(each.transform.rotation)

def compare(message):
    samples[stamp(message.header)] = numbers(message.quaternion)

node.create_subscription(TFMessage, "/tf", take, 1000)
node.create_subscription(QuaternionStamped, "/a/top/orientation", compare, 1000)
while len(transforms.keys() & samples.keys()) < 50:
    rclpy.spin_once(node, timeout_sec=1.0)
(publisher,) = node.get_publishers_info_by_topic("/tf")
both = transforms.keys() & samples.keys()
print(json.dumps({
    "equal": [transforms[each][2] == samples[each] for each in both],
    "names": sorted({transforms[each][0] for each in both}),
    "translations": sorted({transforms[each][1] for each in both}),
    "hash": str(publisher.topic_type_hash),
}))
"""


@pytest.fixture(scope="module")
def with_tf2():
    """An environment in which tf2_msgs can be imported."""
    return with_messages("tf2_msgs", environment(DOMAIN))


def test_tf_is_published_with_the_quaternion_of_the_topic_and_the_type_of_the_log(with_tf2):
    words = command("top_node", "--ros-args", "-r", "__ns:=/a", "--log-level", "warn")
    with running(words, DOMAIN, env=with_tf2):
        heard = execute(bound([sys.executable, "-c", LISTEN]), env=with_tf2)
    assert heard.returncode == 0, heard.stderr
    found = json.loads(heard.stdout)
    assert len(found["equal"]) >= 50
    assert all(found["equal"])  # bit for bit
    assert found["names"] == [["world", "a/top"]]
    assert found["translations"] == [True]
    assert found["hash"] == load_definitions()["tf2_msgs/msg/TFMessage"]["hash"]
