"""~/markers: drawn from the samples, only for a subscriber, and only if it is asked for."""

import sys

import numpy as np
import pytest
from geometry_msgs.msg import Vector3Stamped
from node.running_top import stamp_of

from symtop_ros.models.urdf import LENGTH
from symtop_ros.session import outputs

messages = pytest.importorskip("visualization_msgs.msg")


def end_of(arrow):
    return np.array([getattr(arrow.points[1], axis) for axis in "xyz"])


def test_arrows_point_along_the_vectors_and_the_trace_follows_the_axis(start_top):
    run = start_top(scene="cusps", publish_markers=True)
    seen = run.collect(messages.MarkerArray, "/top/markers")
    momenta = run.collect(Vector3Stamped, "/top/angular_momentum")
    run.spin_until(lambda: len(seen) > 20)
    latest = seen[-1].markers
    assert [each.ns for each in latest] == ["trace", *outputs.ARROWS]
    assert {each.header.frame_id for each in latest} == {"world"}
    stamp = stamp_of(latest[2])
    run.spin_until(lambda: stamp in {stamp_of(each) for each in momenta})
    by_stamp = {stamp_of(each): each.vector for each in momenta}
    vector = np.array([getattr(by_stamp[stamp], axis) for axis in "xyz"])
    end = end_of(latest[2])
    # rounding of a product and a division
    np.testing.assert_allclose(
        end / np.linalg.norm(end), vector / np.linalg.norm(vector), atol=1e-15
    )
    axis = run.top.simulation.segment.state_at(stamp).to_world(np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(
        [getattr(latest[0].points[-1], each) for each in "xyz"], LENGTH * axis, atol=1e-16
    )
    assert len(latest[0].points) == len({(p.x, p.y, p.z) for p in latest[0].points}) > 20
    # thirty times a second, although 200 samples a second do not divide by it
    stamps = np.array([stamp_of(each.markers[0]) for each in seen])
    assert np.diff(stamps // outputs.PERIOD).tolist() == [1] * (len(seen) - 1)


def test_a_missing_package_is_one_line_and_the_markers_are_logged(start_top, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, "visualization_msgs.msg", None)  # as if it were missing
    run = start_top(publish_markers=True)
    run.spin_until(lambda: run.top.simulation.ticker._next > 10)
    line = "visualization_msgs is not installed: ~/markers is only logged"
    assert capfd.readouterr().err.count(line) == 1
