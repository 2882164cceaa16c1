"""Two nodes of one name, or two clocks: a warning until one is gone."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from node.running_top import status_of
from rosgraph_msgs.msg import Clock


@pytest.mark.realtime
def test_a_second_publisher_of_the_clock_is_reported_until_it_is_gone(start_top):
    run = start_top(realtime=True, publish_clock=True)
    heard = run.collect(DiagnosticArray, "/diagnostics")
    other = run.user.create_publisher(Clock, "/clock", 10)

    def clocks():
        return [status_of(each, "top: clock") for each in heard]

    run.spin_until(lambda: clocks() and clocks()[-1].level == b"\1")
    assert {each.key: each.value for each in clocks()[-1].values} == {"publishers": "2"}
    run.user.destroy_publisher(other)
    heard.clear()
    run.spin_until(lambda: clocks() and clocks()[-1].level == b"\0")
