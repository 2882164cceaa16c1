"""One subscriber on every topic of a node in another process, at 1000 Hz."""

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from node.listener import Listener
from node.running_top import facts, stamp_of
from programs import running_node
from rclpy.serialization import deserialize_message

from symtop_ros.simulation.topics import STATE_TOPICS
from workshop.load.domains import claim_domain

pytestmark = [pytest.mark.untraced, pytest.mark.realtime]
DOMAIN = claim_domain()
MS = 1_000_000
SAMPLES = 3000
TOPICS = {name: topic.load_message_class() for name, topic in STATE_TOPICS.items() if name != "tf"}
# For all samples that come while the test has no time. The node sends again what was lost on the
# way only if it has kept it: with 100 samples, its default, a test that stops for 0.5 s loses some.
QUEUE = 20_000
KEPT = [f"qos_overrides./top/{name}.publisher.depth:={QUEUE}" for name in TOPICS]


def test_at_1000_hz_all_samples_that_are_not_missed_arrive_and_stamps_are_one_millisecond_apart():
    with running_node(DOMAIN, "publish_rate:=1000", *KEPT), Listener(DOMAIN) as listener:
        diagnostics = listener.collect(DiagnosticArray, "/diagnostics")
        got = {
            name: listener.collect(kind, f"/top/{name}", qos=QUEUE, raw=True)
            for name, kind in TOPICS.items()
        }
        listener.spin_until(lambda: min(map(len, got.values())) >= SAMPLES)
        arrived = {name: stamps_of(messages, TOPICS[name]) for name, messages in got.items()}
        last = max(stamps[-1] for stamps in arrived.values())
        listener.spin_until(lambda: diagnostics and stamp_of(diagnostics[-1]) > last)
    missed = int(facts(diagnostics[-1], "top: pace")["missed"])
    for stamps in arrived.values():
        assert not (np.diff(stamps) % MS).any()  # on the grid, to the nanosecond
        absent = (stamps[-1] - stamps[0]) // MS + 1 - len(stamps)
        assert absent <= missed  # what the machine has no time for is counted


def stamps_of(messages, kind):
    return np.array([stamp_of(deserialize_message(each, kind)) for each in messages])
