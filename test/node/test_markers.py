"""~/markers: drawn from the samples, only for a subscriber, and only if it is asked for."""

import sys


def test_a_missing_package_is_one_line_and_the_markers_are_logged(start_top, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, "visualization_msgs.msg", None)  # as if it were missing
    run = start_top(publish_markers=True)
    run.spin_until(lambda: run.top.simulation.ticker._next > 10)
    line = "visualization_msgs is not installed: ~/markers is only logged"
    assert capfd.readouterr().err.count(line) == 1
