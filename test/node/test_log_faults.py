"""A folder that fails: one error, the motion keeps running, and the next log is complete."""

import sys
from itertools import pairwise

from diagnostic_msgs.msg import DiagnosticArray
from disks import mounted, remount
from exact_log import assert_exact, stamps_of
from node.listener import Listener
from node.running_top import facts, status_of
from programs import running, set_parameters
from sensor_msgs.msg import JointState

from workshop.load.domains import claim_domain
from workshop.load.endings import bound

DOMAIN = claim_domain()
MS = 1_000_000
UNWRITABLE = "record.directory must be a writable folder, got"
LATE = """
import sys
from symtop_ros.programs import top_node
from symtop_ros.log import recorder
recorder.FLUSH_PERIOD = 3600.0
sys.exit(top_node())
"""


class Recording:
    """A top that records into a folder, and its reports."""

    def __init__(self, start_top, folder):
        self.run = start_top(publish_rate=500.0, record__directory=str(folder))
        self._events = self.run.collect_events()
        self._angles = self.run.collect(JointState, "/top/euler_angles", raw=True)

    @property
    def errors(self):
        told = map(facts, self._events)
        found = [each for each in told if each.get("outcome.kind") == "stopped"]
        assert all(each["motion.running"] == "true" for each in found)
        return [each["outcome.failure"] for each in found]

    def switch(self, on):
        """Begin or end; return the file, or the answer that refuses."""
        granted, answer = self.run.switch("record", on)
        return self.run.last_log if granted else answer

    def wait(self, samples=100):
        self.run.wait_for(self._angles, samples)

    def assert_works(self):
        """The motion keeps running, and the next recording is complete."""
        self.wait()
        path = self.switch(True)
        self.wait()
        assert self.run.trigger("hurry_precession")[0]
        self.wait()
        assert self.switch(False) == path
        assert assert_exact(path) > 20
        assert not any((b - a) % (2 * MS) for a, b in pairwise(stamps_of(path)))


def test_a_folder_that_is_read_only_is_refused_until_it_is_not(start_top, tmp_path):
    with mounted(tmp_path, "ro,size=10m"):
        recording = Recording(start_top, tmp_path)
        refusal = f"{UNWRITABLE} {str(tmp_path)!r}: Read-only file system"
        assert [recording.switch(True) for _ in range(2)] == [refusal] * 2
        remount(tmp_path, "rw")
        recording.assert_works()
        assert recording.errors == []
        recording.run.top.close()


def test_a_log_that_is_deleted_while_it_is_written_is_one_error(start_top, tmp_path):
    recording = Recording(start_top, tmp_path)
    diagnostics = recording.run.collect(DiagnosticArray, "/diagnostics")
    path = recording.switch(True)
    recording.wait()
    path.unlink()
    recording.run.spin_until(lambda: recording.errors)
    recording.run.spin_until(
        lambda: diagnostics and status_of(diagnostics[-1], "top: log").level == b"\2"
    )
    assert "the file was removed" in status_of(diagnostics[-1], "top: log").message
    recording.assert_works()
    assert recording.errors == [f"{path}: the file was removed"]


def test_a_log_that_fails_at_the_very_end_is_one_line(tmp_path):
    options = set_parameters(f"record.directory:={tmp_path}", "record.enabled:=true")
    words = bound([sys.executable, "-c", LATE, *options])
    with running(words, DOMAIN) as node, Listener(DOMAIN) as listener:
        angles = listener.collect(JointState, "/top/euler_angles")
        listener.spin_until(lambda: len(angles) > 20)
        (path,) = tmp_path.iterdir()
        path.unlink()
        node.terminate()
        _, errors = node.communicate(timeout=60)
    # A machine that is overloaded adds its own warning, which is not the matter here.
    lines = [line for line in errors.splitlines() if "no samples for" not in line]
    assert lines == [f"top_node: recording stopped: {path}: the file was removed"]
    assert node.returncode == 1
