import pytest
from sensor_msgs.msg import JointState

from symtop_ros.client.connection import UnreachableError
from symtop_ros.client.keys import watch

SAMPLE = JointState(position=[0.1, 0.5, 0.2], velocity=[9.0, 0.0, 200.0])


class Top:
    """A connection that delivers some samples, one for each call."""

    name = "/top"

    def __init__(self, samples):
        self._left = samples
        self._take = None

    def subscribe(self, kind, topic, take):
        assert (kind, topic) == (JointState, "euler_angles")
        self._take = take

    def spin_until(self, done, timeout):
        if self._left:
            self._left -= 1
            self._take(SAMPLE)
        return done()


def test_missing_samples_are_reported():
    with pytest.raises(UnreachableError, match="no samples from /top within 1 s"):
        watch(Top(samples=4), seconds=60.0, timeout=1.0)
