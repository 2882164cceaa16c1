"""One subscriber on every topic of a node in another process, at 1000 Hz."""

import time

import numpy as np
import pytest
import rclpy
from domains import claim_domain
from node.running_top import stamp_of
from programs import running_node
from rclpy.executors import SingleThreadedExecutor
from rclpy.serialization import deserialize_message

from symtop_ros.simulation.topics import STATE_TOPICS

pytestmark = [pytest.mark.untraced, pytest.mark.realtime]
DOMAIN = claim_domain()
SAMPLES = 3000
TOPICS = {name: topic.load_message_class() for name, topic in STATE_TOPICS.items() if name != "tf"}


def test_at_1000_hz_samples_arrive_and_stamps_are_one_millisecond_apart():
    with running_node(DOMAIN, "publish_rate:=1000"):
        got = listen()
    for name, messages in got.items():
        stamps = np.array([stamp_of(deserialize_message(each, TOPICS[name])) for each in messages])
        sent = (stamps[-1] - stamps[0]) // 1_000_000 + 1
        assert not (np.diff(stamps) % 1_000_000).any()  # on the grid, to the nanosecond
        assert len(stamps) >= 0.995 * sent
        assert len(stamps) >= SAMPLES


def listen():
    """Serialized messages of every topic, until each has enough."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=DOMAIN)
    listener = rclpy.create_node("listener", context=context)
    got = {name: [] for name in TOPICS}
    for name, kind in TOPICS.items():
        listener.create_subscription(kind, f"/top/{name}", got[name].append, 1000, raw=True)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(listener)
    deadline = time.monotonic() + 120
    while min(map(len, got.values())) < SAMPLES and time.monotonic() < deadline:
        executor.spin_once(timeout_sec=0.1)
    rclpy.shutdown(context=context)
    return got
