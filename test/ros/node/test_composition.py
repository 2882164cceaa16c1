"""The node in the process of a user: with other nodes in one executor, of one thread or several."""

import time

import pytest
import rclpy
from geometry_msgs.msg import QuaternionStamped
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from waiting import TIMEOUT

from symtop_ros.ros.node.top_node import TopNode
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from workshop.load.domains import claim_domain, release_domain

KICK = Parameter("precession_rate_factor", value=1.25).to_parameter_msg()
KICKS = 12


class Kicker(Node):
    """A node of the user: it counts samples of a top, and kicks it from a timer."""

    def __init__(self, name, top, context):
        super().__init__(name, context=context)
        group = ReentrantCallbackGroup()
        self.samples, self.answers = 0, []
        self.client = self.create_client(
            SetParametersAtomically, f"{top}/kick", callback_group=group
        )
        self.create_subscription(
            QuaternionStamped, f"{top}/orientation", self.count, 100, callback_group=group
        )
        self.create_timer(0.01, self.kick, callback_group=group)

    def count(self, _):
        self.samples += 1

    def kick(self):
        if self.client.service_is_ready() and len(self.answers) < KICKS:
            request = SetParametersAtomically.Request(parameters=[KICK])
            self.answers.append(self.client.call_async(request))

    @property
    def is_done(self):
        return len(self.answers) == KICKS and all(each.done() for each in self.answers)


def make_top(context, name, folder):
    """A top that records; its arguments are those of a node."""
    values = {"scene": "hurry_slow", "record.enabled": True, "record.directory": str(folder)}
    return TopNode(
        context=context,
        cli_args=["--ros-args", "-r", f"__node:={name}"],
        parameter_overrides=[Parameter(key, value=value) for key, value in values.items()],
    )


@pytest.fixture(name="context")
def _context():
    domain = claim_domain()
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    yield context
    rclpy.try_shutdown(context=context)
    release_domain(domain)


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_two_tops_and_two_nodes_of_a_user_share_an_executor(kind, context, tmp_path):
    folders = [tmp_path / name for name in ("one", "two")]
    tops = [make_top(context, folder.name, folder) for folder in folders]
    users = [Kicker(f"user_of_{folder.name}", f"/{folder.name}", context) for folder in folders]
    executor = kind(context=context)
    for node in (*tops, *users):
        executor.add_node(node)
    try:
        deadline = time.monotonic() + TIMEOUT
        while not all(user.is_done and user.samples > 20 for user in users):
            assert time.monotonic() < deadline, [(u.samples, len(u.answers)) for u in users]
            executor.spin_once(timeout_sec=0.1)
    finally:
        executor.shutdown()
        for node in (*users, *tops):
            node.destroy_node()
    assert all(each.result().result.successful for user in users for each in user.answers)
    for folder, top in zip(folders, tops, strict=True):
        assert top.failure is None
        log = TopLog(open_run([*folder.iterdir()]))
        found = check_run(log)
        assert (found.mismatches, found.samples_agree, found.laws_hold) == ([], True, True)
        assert log.account.problems == ()
        assert [each.name for each in log.account.events] == ["start", *["kick"] * KICKS]
