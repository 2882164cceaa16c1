"""Two nodes of one name, or two clocks: a warning until one is gone."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from node.running_top import status_of
from rosgraph_msgs.msg import Clock

from symtop_ros.node.top_node import TopNode

DUPLICATE = "another node has the name /top, and a request reaches any of them: rename this one"


@pytest.mark.realtime
def test_two_nodes_of_one_name_warn_until_one_is_gone(start_top):
    first = start_top(realtime=True)
    second = TopNode(context=first.context)
    first.executor.add_node(second)
    heard = first.collect(DiagnosticArray, "/diagnostics")

    def names():
        return [status_of(each, "top: name") for each in heard]

    first.spin_until(lambda: sum(each.level == b"\1" for each in names()) >= 2)
    assert DUPLICATE in names()[-1].message
    for _ in range(3):
        granted, answer = first.trigger("hurry_precession")
        assert granted
        assert answer.count("Precession") == 1
    first.executor.remove_node(second)
    second.destroy_node()
    heard.clear()
    first.spin_until(lambda: names() and names()[-1].level == b"\0")
    assert names()[-1].message == "no other node has the name /top"


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
