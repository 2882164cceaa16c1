import pytest
import rclpy
from std_srvs.srv import Trigger

from symtop_ros.client.connection import Connection, UnreachableError
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


def test_a_service_that_does_not_answer_is_reported_after_the_time_out():
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=DOMAIN)
    try:
        silent = rclpy.create_node("silent", context=context)  # it is never spun
        silent.create_service(Trigger, "~/reset", lambda _, response: response)
        user = rclpy.create_node("user", context=context)
        with pytest.raises(UnreachableError, match=r"/silent/reset did not answer within 3 s"):
            Connection(user, "/silent", timeout=3.0).trigger("reset")
    finally:
        rclpy.shutdown(context=context)
