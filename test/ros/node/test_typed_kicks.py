"""A kick as rqt, Python and C++ type it in docs/ros.md."""

import rcl_interfaces.msg
from documents import ROOT, blocks
from rcl_interfaces.srv import SetParametersAtomically
from ros.node.running_top import events_named, facts
from stub_of_rclcpp import HEADERS, assert_compiles, needs_compiler

PAGE = ROOT / "docs/ros.md"
RATE = 9.0  # rad/s, of all three
(RQT,) = (code for code, _ in blocks(PAGE, "text") if code.startswith("[rcl_interfaces.msg."))
(PYTHON,) = (code for code, _ in blocks(PAGE, "python") if "def kick(" in code)
((CPP, _),) = blocks(PAGE, "cpp")


def assert_kicks(run, send):
    """A request that is sent by a function is granted, and is the kick that the page speaks of."""
    events = run.collect_events()
    answer = send()
    run.spin_until(answer.done)
    result = answer.result().result
    assert result.successful, result.reason
    run.spin_until(lambda: events_named(events, "kick"))
    (event,) = events_named(events, "kick")
    assert float(facts(event)["request.precession_rate"]) == RATE


def test_the_expression_of_rqt_is_a_request(start_top):
    """rqt_service_caller imports the package that an expression begins with, and evaluates it."""
    run = start_top(scene="hurry_slow")
    given = eval(RQT, {"rcl_interfaces": rcl_interfaces})
    client = run.user.create_client(SetParametersAtomically, "/top/kick")
    run.spin_until(client.service_is_ready)
    request = SetParametersAtomically.Request(parameters=given)
    assert_kicks(run, lambda: client.call_async(request))


def test_the_function_in_python_kicks(start_top):
    run = start_top(scene="hurry_slow")
    variables = {}
    exec(PYTHON, variables)
    assert_kicks(run, lambda: variables["kick"](run.user, RATE))


@needs_compiler
def test_a_compiler_reads_the_cpp(tmp_path):
    source = tmp_path / "kick.cpp"
    includes = "".join(f'#include "{name}"\n' for name in HEADERS)
    source.write_text(f"{includes}void kick(std::shared_ptr<rclcpp::Node> node) {{\n{CPP}}}\n")
    assert_compiles(source, tmp_path)
    assert f'"precession_rate", {RATE}' in CPP
