"""Filters by the methods of imu_tools, fed by the node under REP-145's names."""

import numpy as np
import pytest

pytest.importorskip("ahrs", reason="no ahrs: pip install ahrs")
from ros.node.running_top import RunningTop
from sensor_msgs.msg import Imu, MagneticField
from trials import choose

from examples.attitude_filter import FILTERS, AttitudeFilter
from symtop_ros.base.arrays import compose, invert

# Madgwick, Harrison, Vaidyanathan (2011): root mean square in motion; Valenti's is held to it, too.
PROMISE = np.radians(1.7)
REMAPPED = ["--ros-args", "-r", "~/imu:=imu/data_raw", "-r", "~/magnetic_field:=imu/mag"]
SENSOR = {"imu__enabled": True, "magnetic_field__enabled": True, "initial__phi": 2.0}
COUNT = 200  # samples at 200 Hz: half a turn of the pendulum


def read_attitudes(messages):
    fields = (each.orientation for each in messages)
    return np.array([[each.w, each.x, each.y, each.z] for each in fields])


@pytest.mark.parametrize("name", choose(FILTERS, ("Madgwick",)))
def test_a_filter_of_imu_tools_holds_yaw_and_tilt_of_a_slow_top(name):
    with RunningTop(arguments=REMAPPED, scene="conical_pendulum", **SENSOR) as run:
        program = AttitudeFilter(name, context=run.context)
        run.executor.add_node(program)
        given = run.collect(Imu, "/imu/data_raw")
        fields = run.collect(MagneticField, "/imu/mag")
        found = run.collect(Imu, "/imu/data")
        run.wait_for(found, COUNT)
        program.destroy_node()
    assert {each.header.frame_id for each in (*given, *fields)} == {"top_imu"}
    for each in fields:
        b = each.magnetic_field
        assert np.hypot(np.hypot(b.x, b.y), b.z) == pytest.approx(4.924e-5, rel=1e-4)  # T, rounded
    exact = {str(each.header.stamp): each for each in given}
    # Each subscription is found at another moment: the filter may have got samples before the test.
    judged = [each for each in found if str(each.header.stamp) in exact]
    assert len(judged) > COUNT / 2
    truth = read_attitudes([exact[str(each.header.stamp)] for each in judged])
    w, x, y, z = compose(read_attitudes(judged), invert(truth)).T
    yaw = 2 * np.arctan(z / w)
    tilt = 2 * np.arcsin(np.hypot(x, y))
    assert np.sqrt(np.mean(yaw**2)) < PROMISE
    assert np.sqrt(np.mean(tilt**2)) < PROMISE
