"""The node: ROS around a simulation."""

import time
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from typing import Any, cast

from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import Clock, ClockChange, JumpThreshold, ROSClock, TimeJump
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from rclpy.serialization import deserialize_message
from rclpy.utilities import get_rmw_implementation_identifier

from symtop_ros.base.refusals import RefusedError, attempt, refuse
from symtop_ros.physics import kernel_version
from symtop_ros.ros.node.host import NodeHost, Pacer, distribution_name
from symtop_ros.ros.node.parameters import (
    SERVICE_TYPES,
    declare_parameters,
    fill_response,
    guard_parameters,
    tell_zeros,
    warn_of_unused_qos,
)
from symtop_ros.run.session.services import SERVICES
from symtop_ros.run.session.session import Session
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.clocks import JUMP
from symtop_ros.run.simulation.settings import PARAMETERS, Settings
from symtop_ros.run.simulation.simulation import Simulation
from symtop_ros.run.simulation.topics import APPLIED_TORQUE, DEFAULT_NAME
from symtop_ros.run.wire.layout import NANOSECONDS

__all__ = ["TopNode"]

SIM_TIME = "use_sim_time"
CLOCK_WAIT = 2.0  # s between two checks that a simulated clock is there


class NodeClock:
    """The clock of a node, as a simulation needs it."""

    def __init__(self, node: Node) -> None:
        self._clock = cast(ROSClock, node.get_clock())

    @property
    def now(self) -> int:
        """Current time in ns."""
        return int(self._clock.now().nanoseconds)

    @property
    def is_simulated(self) -> bool:
        """True if the time comes from /clock."""
        return self._clock.ros_time_is_active

    @property
    def steady(self) -> int:
        """Time in ns of a clock that cannot be set."""
        return time.monotonic_ns()


class SteadyClock:
    """The real time of a run that publishes /clock: it cannot be set."""

    is_simulated = False

    @property
    def now(self) -> int:
        """Current time in ns."""
        return time.monotonic_ns()

    @property
    def steady(self) -> int:
        """The same time."""
        return self.now


class TopNode(Node):
    """A heavy symmetric top in real time; docs/ros_reference.md lists its interface.

    Ticks run in a thread of the pacer, requests and timers in the executor's.
    """

    _simulator: Any = None  # the interface of all simulators, if it can be offered

    def __init__(self, **options: Any) -> None:
        super().__init__(DEFAULT_NAME, **options)
        settings = declare_parameters(self)
        self._refuse_own_clock(settings, self.get_parameter(SIM_TIME).value)
        host = NodeHost(self, settings)
        self.session = Session(
            settings,
            SteadyClock() if settings.publish_clock else NodeClock(self),
            host,
            scene=str(self.get_parameter("scene").value),
            environment={
                "rmw": get_rmw_implementation_identifier(),
                "ros_distro": distribution_name(),
            },
            name=self.get_fully_qualified_name(),
        )
        warn_of_unused_qos(self)
        for name, service in SERVICES.items():
            kind, read = SERVICE_TYPES[service.kind]
            self.create_service(kind, f"~/{name}", self._handler(name, read))
        # Best effort, so that publishers of either reliability are received.
        best_effort = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(
            WrenchStamped, APPLIED_TORQUE.ros_name, self._apply_torque, best_effort, raw=True
        )
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        self.create_timer(1.0, self.session.keep_up)
        # By the host, whose warnings may come in a tick: rclpy takes 10 ms for the first of a file.
        host.inform(f"states are computed by the kernel, version {kernel_version()}")
        self.clock_is_missing = False
        # On a steady clock, as it also ends the node: rclpy 7 may wake the executor a moment before
        # a signal has shut ROS down, which then waits for its next event.
        self.create_timer(
            CLOCK_WAIT, self._check_clock, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self._pacer = Pacer(self.simulation.tick, settings.scheduling_priority, host.warn)
        if find_spec("simulation_interfaces"):
            from symtop_ros.ros.node.simulator import Simulator  # noqa: PLC0415 - it needs its messages

            self._simulator = Simulator(self, self.session, self._pacer.wake)
        # Whenever simulated time is set. Kept, as rclpy forgets a callback whose handle is gone.
        self._clock_handle = self.get_clock().create_jump_callback(
            JumpThreshold(
                min_forward=Duration(nanoseconds=1),
                min_backward=Duration(nanoseconds=-1),
                on_clock_change=True,
            ),
            pre_callback=self.simulation.begin_jump,
            post_callback=self._clock_set,
        )

    @property
    def simulation(self) -> Simulation:
        """The simulation of the session."""
        return self.session.simulation

    @property
    def failure(self) -> Failure | None:
        """Failure that ended the top, or None; the other nodes of its executor continue."""
        return self.simulation.failure

    def close(self) -> None:
        """End the ticks and the recording."""
        self._pacer.stop()
        self.session.close()

    def destroy_node(self) -> None:
        """Close, then remove the node; also called by rclpy if the constructor failed."""
        if hasattr(self, "_pacer"):
            self.close()
        if self._simulator:
            self._simulator.close()
        super().destroy_node()

    # Time

    def _check_clock(self) -> None:
        """Warn once if time is simulated and nothing has set it: the top then stands still."""
        clock = NodeClock(self)
        missing = clock.is_simulated and not clock.now
        if missing and not self.clock_is_missing:
            self.get_logger().warning(
                f"use_sim_time is true, but no /clock was received for {CLOCK_WAIT:g} s: no samples"
            )
        self.clock_is_missing = missing

    def _clock_set(self, jump: TimeJump) -> None:
        """Follow a jump of simulated time; any change of it wakes the pacer."""
        self.simulation.end_jump(
            jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
            or not 0 <= jump.delta.nanoseconds < JUMP * NANOSECONDS
        )
        self._pacer.wake()

    # Requests

    def create_service(self, *arguments: Any, **options: Any) -> Any:
        """Create a service; rclpy creates its parameter services by this method too."""
        kind, name, handler, *others = arguments
        return super().create_service(
            kind, name, guard_parameters(self, name, handler), *others, **options
        )

    def _handler(self, name: str, read: Callable[[Any], Any]) -> Any:
        def handle(request: Any, response: Any) -> Any:
            granted, answer = self.session.answer(name, lambda: read(request))
            self._pacer.wake()  # a clock that stood still may be running
            if granted and isinstance(request, SetParametersAtomically.Request):
                answer = tell_zeros(request.parameters) + answer
            return fill_response(response, granted, answer)

        return handle

    def _apply_torque(self, data: bytes) -> None:
        self.session.log_torque(data)
        message = deserialize_message(data, WrenchStamped)
        parts = message.wrench.force, message.wrench.torque
        force, torque = ((each.x, each.y, each.z) for each in parts)
        if any(force):
            reason = str(refuse("applied_torque force", "0 (only the torque acts)", force))
        else:
            reason = self.session.hold_torque(torque, message.header.frame_id)
        if reason:
            self.get_logger().warning(reason, throttle_duration_sec=1.0)

    # Parameters

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        simulated = any(each.name == SIM_TIME and each.value for each in parameters)

        def check() -> None:
            self._refuse_own_clock(self.session.plan_settings(_own_values(parameters)), simulated)

        found = self.simulation.take_turn("a check of parameters", partial(attempt, check))
        granted, reason = (False, str(found)) if isinstance(found, Failure) else found
        return SetParametersResult(successful=granted, reason=reason)

    def _refuse_own_clock(self, settings: Settings, simulated: Any) -> None:
        """Refuse to follow the /clock that the node itself publishes: it would stand still."""
        if simulated and settings.publish_clock:
            raise RefusedError("publish_clock must be false together with use_sim_time, got true")

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        self.simulation.take_turn(
            "a change of parameters",
            partial(self.session.apply_settings, _own_values(parameters)),
        )
        self._pacer.wake()


def _own_values(parameters: list[Parameter]) -> dict[str, Any]:
    """Return the parameters of the top; a node has others, such as use_sim_time."""
    return {each.name: each.value for each in parameters if each.name in PARAMETERS}
