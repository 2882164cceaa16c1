"""Parts of top_ctl without a node: words, samples, and a service that is silent."""

import subprocess
import sys

import pytest
import rclpy
from node.listener import Listener
from std_srvs.srv import Trigger

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.client.main import parse_values
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


def test_a_service_that_does_not_answer_is_reported_after_the_time_out():
    with Listener(DOMAIN, "user") as user:
        silent = rclpy.create_node("silent", context=user.context)  # it is never spun
        silent.create_service(Trigger, "~/reset", lambda _, response: response)
        with pytest.raises(UnreachableError, match=r"/silent/reset did not answer within 1 s"):
            Connection(user.node, "/silent", timeout=1.0).request("reset")


def test_a_harmless_question_is_answered_before_the_first_request_to_a_service():
    asked = []

    def note(name):
        return lambda _, response: asked.append(name) or response

    with Listener(DOMAIN, "user") as user:
        top = rclpy.create_node("top", context=user.context)
        for name in ("get_state", "reset"):
            top.create_service(Trigger, f"~/{name}", note(name))
        connection = Connection(user.node, timeout=60.0)
        connection._executor.add_node(top)
        for _ in range(2):
            connection.request("reset")
        connection.close()
    assert asked == ["get_state", "reset", "reset"]


def test_words_become_numbers_lists_and_text():
    assert parse_values(["a=9", "b=-1e-3", "c=0,0,1e-4", "d=[1, 2]", "e=slow", "f=9_1"]) == {
        "a": 9.0,
        "b": -1e-3,
        "c": [0.0, 0.0, 1e-4],
        "d": [1.0, 2.0],
        "e": "slow",
        "f": "9_1",
    }


def test_it_is_imported_where_there_are_no_terminals():
    """As on Windows: only `top_ctl keys` needs them."""
    code = "import sys; sys.modules.update(termios=None, tty=None); import symtop_ros.client.main"
    subprocess.run([sys.executable, "-c", code], check=True)
