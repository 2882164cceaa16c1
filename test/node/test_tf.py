"""/tf with the real tf2_msgs, between processes."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from programs import command, environment

from symtop_ros.log.definitions import load_definition
from workshop.load.domains import claim_domain
from workshop.load.endings import bound

pytestmark = pytest.mark.untraced
DOMAIN = claim_domain()
BUILD = Path(__file__).parents[1] / "build_tf2_msgs.py"
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
def with_tf2(tmp_path_factory):
    """An environment in which tf2_msgs can be imported."""
    variables = environment(DOMAIN)
    if importlib.util.find_spec("tf2_msgs"):
        return variables
    if not (shutil.which("gcc") and shutil.which("g++")):
        pytest.skip("tf2_msgs is not installed, and there is no compiler to build it")
    folder = tmp_path_factory.mktemp("tf2")
    subprocess.run(
        [sys.executable, BUILD, folder], check=True, capture_output=True, timeout=120, text=True
    )
    for name, place in (("PYTHONPATH", folder), ("LD_LIBRARY_PATH", folder / "lib")):
        variables[name] = os.pathsep.join(filter(None, [str(place), variables.get(name)]))
    return variables


def test_tf_is_published_with_the_quaternion_of_the_topic_and_the_type_of_the_log(with_tf2):
    options = ("--ros-args", "-r", "__ns:=/a", "--log-level", "warn")
    node = subprocess.Popen(command("top_node", *options), env=with_tf2)
    try:
        heard = subprocess.run(
            bound([sys.executable, "-c", LISTEN]),
            env=with_tf2,
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
    finally:
        node.terminate()
        node.wait(timeout=60)
    assert heard.returncode == 0, heard.stderr
    found = json.loads(heard.stdout)
    assert len(found["equal"]) >= 50
    assert all(found["equal"])  # bit for bit
    assert found["names"] == [["world", "a/top"]]
    assert found["translations"] == [True]
    assert found["hash"] == load_definition("tf2_msgs/msg/TFMessage").type_hash
