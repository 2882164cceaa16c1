"""Two nodes of one name."""

from diagnostic_msgs.msg import DiagnosticArray

from symtop_ros.node.top_node import TopNode

NAME = 4  # of the statuses in /diagnostics
NAMED_TOO = "another node is named /top, and requests reach any of them: give this one"


def test_two_nodes_of_one_name_say_so_until_one_is_gone(start_top):
    first = start_top()
    second = TopNode(context=first.context)
    first.executor.add_node(second)
    heard = first.collect(DiagnosticArray, "/diagnostics")

    def names():
        return [each.status[NAME] for each in heard]

    first.spin_until(lambda: sum(each.level == b"\1" for each in names()) >= 2)
    assert NAMED_TOO in names()[-1].message
    for _ in range(3):
        granted, answer = first.trigger("hurry_precession")
        assert granted
        assert answer.count("precession") == 1
    first.executor.remove_node(second)
    second.destroy_node()
    heard.clear()
    first.spin_until(lambda: names() and names()[-1].level == b"\0")
    assert names()[-1].message == "no other node is named /top"
