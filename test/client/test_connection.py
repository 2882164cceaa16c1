import pytest
import rclpy
from node.listener import Listener
from std_srvs.srv import Trigger

from symtop_ros.client.connection import Connection, UnreachableError
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


def test_a_service_that_does_not_answer_is_reported_after_the_time_out():
    with Listener(DOMAIN, "user") as user:
        silent = rclpy.create_node("silent", context=user.context)  # it is never spun
        silent.create_service(Trigger, "~/reset", lambda _, response: response)
        with pytest.raises(UnreachableError, match=r"/silent/reset did not answer within 3 s"):
            Connection(user.node, "/silent", timeout=3.0).trigger("reset")
