"""The node `top`: parameters, services, the clock, and a thread that calls for samples."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import ClockChange, JumpThreshold, ROSClock, TimeJump
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter

from symtop_ros.node import initial
from symtop_ros.node.course import JUMP, SECOND, Course
from symtop_ros.node.diagnostics import diagnostics
from symtop_ros.node.fields import RefusedError
from symtop_ros.node.log import Log, limits
from symtop_ros.node.namesakes import Namesakes
from symtop_ros.node.outputs import Outputs
from symtop_ros.node.pacer import Pacer
from symtop_ros.node.parameters import DECLARATIONS, Settings, checked, declare
from symtop_ros.node.requests import Handle, Requests
from symtop_ros.node.typed_requests import with_known_types
from symtop_ros.recording.recorder import Recorder
from symtop_ros.wire.diagnostics import packed
from symtop_ros.wire.text import one_line

SIM_TIME = "use_sim_time"
CLOCK_CHANGES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)


class TopNode(Node):
    """A heavy symmetric top in real time; topics, services and parameters as in the README.

    Ticks come from a thread of the node's own, requests from the executor; they take turns.

    Attributes
    ----------
    course : Course
        What moves, and how far it is published.
    log : Log
        What of it is recorded.
    failure : Exception or None
        What the ticks ended with.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("top", **options)
        settings = declare(self)
        self._refuse_own_clock(settings, self.get_parameter(SIM_TIME).value)
        start = initial.initial_state(settings.top, settings.initial, {})
        self._turn = threading.RLock()
        self.failure: Exception | None = None
        self._mistakes: dict[str, str] = {}
        self._jumped_to: int | None = None
        self._begin(settings, start)
        self._offer_services()
        self.create_subscription(WrenchStamped, "~/applied_torque", self._take_torque, 10)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        self.create_timer(1.0, self._diagnose)
        self._pacer = Pacer(self._tick, self._fail)
        self._follow_clock()

    def _begin(self, settings: Settings, start: Any) -> None:
        """Begin the run, and its log where one is asked for."""
        logger, scene = self.get_logger(), str(self.get_parameter("scene").value)
        self._recorder = Recorder(Path(settings["record.directory"]), limits(settings))
        frames = settings["world_frame"], settings["top_frame"]
        self._outputs = Outputs(self, self._recorder, *frames, settings["publish_clock"])
        self._outputs.publish_tf(settings["publish_tf"])
        clock = cast(ROSClock, self.get_clock())
        self.course = Course(settings, start, self._outputs, clock, logger)
        self.course.announce("start", self.course.verdict, {"scene": scene}, start)
        self.log = Log(self._recorder, self.course, scene, logger)
        if settings["record.enabled"]:
            self.log.begin()
        self._requests = Requests(self.course, self.log, start)
        self._namesakes = Namesakes(self)
        logger.info(f"scene {scene}: {self.course.verdict}")

    def close(self) -> None:
        """End the ticks and the log; the node can go."""
        self._pacer.stop()
        self._recorder.stop()

    def destroy_node(self) -> None:
        """Close, and take the node from the graph; rclpy does so too where none was made."""
        if hasattr(self, "_pacer"):
            self.close()
        super().destroy_node()

    # time

    def _tick(self) -> float | None:
        """Publish what is due; return how long nothing will be, None where the clock will tell."""
        with self._turn:
            course = self.course
            jumped_to, self._jumped_to = self._jumped_to, None
            if course.now < course.stamp - (JUMP + 1 / course.ticker.rate) * SECOND:
                jumped_to = course.now  # the clock of the system, which tells nobody
            if jumped_to is not None:
                course.follow_jump(jumped_to)
            if not course.advance():
                return 0.0
            wait = (course.stamp - course.now) / SECOND
            return None if course.simulated and wait > 0 else wait

    def _fail(self, error: Exception) -> None:
        """End the node when a tick cannot be done; a context that has ended is no failure."""
        if self.context.ok():
            self.failure = error
            self.get_logger().fatal(f"a tick failed: {type(error).__name__}: {one_line(error)}")
            self.context.try_shutdown()

    def _diagnose(self) -> None:
        with self._turn, self._mistakes_told("/diagnostics"):
            self._namesakes.look()
            course, output = self.course, self._outputs.diagnostics
            course.settle()
            course.speed_up()
            self.log.report_failure()
            if output.wanted:
                facts = course.segment, course.stamp, course.ticker, self._recorder, self._namesakes
                found = diagnostics(course.settings, *facts)
                output.send(course.stamp, packed(course.stamp, course.frame, found))

    def _follow_clock(self) -> None:
        """Learn when simulation time is set; then it alone says when ticks are due."""
        threshold = JumpThreshold(
            min_forward=Duration(nanoseconds=1),
            min_backward=Duration(nanoseconds=-1),
            on_clock_change=True,
        )
        clock = self.get_clock()
        self._clock_handle = clock.create_jump_callback(threshold, post_callback=self._clock_set)

    def _clock_set(self, jump: TimeJump) -> None:
        """Note a jump; it is called from within the clock, which must not wait for a turn."""
        changed = jump.clock_change in CLOCK_CHANGES
        if changed or not 0 <= jump.delta.nanoseconds < JUMP * SECOND:
            self._jumped_to = self.course.now
        self._pacer.wake()

    # requests

    def create_service(self, *arguments: Any, **options: Any) -> Any:
        """Offer a service; rclpy makes its own, for parameters, by this too."""
        kind, name, handle, *others = arguments
        return super().create_service(
            kind, name, with_known_types(kind, handle), *others, **options
        )

    def _offer_services(self) -> None:
        for name, (kind, handle) in self._requests.services.items():
            self.create_service(kind, f"~/{name}", self._answering(name, handle))

    def _answering(self, name: str, handle: Handle) -> Any:
        """Turn a sentence or a refusal into the response of any of the service types.

        What is due by then is published at once, and need not wait for the pacer's turn.
        """

        def answer(request: Any, response: Any) -> Any:
            with self._turn:
                granted, sentence = self._answer(name, handle, request)
                self._tick()
            if isinstance(response, SetParametersAtomically.Response):
                response.result = SetParametersResult(successful=granted, reason=sentence)
            else:
                response.success, response.message = granted, sentence
            return response

        return answer

    def _answer(self, name: str, handle: Handle, request: Any) -> tuple[bool, str]:
        """Do what is asked; return whether it was done, and a sentence."""
        self.course.settle()
        with self._mistakes_told(f"~/{name}") as told:
            try:
                return True, handle(request)
            except RefusedError as refusal:
                return False, str(refusal)
        return False, told[0]

    @contextmanager
    def _mistakes_told(self, name: str) -> Iterator[list[str]]:
        """After a mistake of our own the motion goes on, and a line and an event tell it.

        What is given holds the sentence then. A mistake is not told again and again.
        """
        told: list[str] = []
        stamp, before = self.course.stamp, self.course.segment
        try:
            yield told
            self._mistakes.pop(name, None)
        except Exception as error:
            if not self.context.ok():
                raise
            told.append(f"{name} failed: {type(error).__name__}: {one_line(error)}")
            if self._mistakes.get(name) != told[0] or self.course.segment is not before:
                self._mistakes[name] = told[0]
                self.get_logger().error(told[0])
                state = before.state_at(stamp)
                self.course.announce("failure", told[0], {}, state, stamp)

    def _take_torque(self, message: WrenchStamped) -> None:
        with self._turn, self._mistakes_told("~/applied_torque"):
            self.course.settle()
            try:
                self.course.hold_torque(message)
            except RefusedError as refusal:
                self.get_logger().warning(str(refusal), throttle_duration_sec=1.0)

    # parameters

    def _check_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        simulated = any(each.name == SIM_TIME and each.value for each in parameters)
        with self._turn, self._mistakes_told("a check of parameters") as told:
            try:
                self._refuse_own_clock(checked(self._with(parameters)), simulated)
            except RefusedError as refusal:
                return SetParametersResult(successful=False, reason=str(refusal))
            return SetParametersResult(successful=True)
        return SetParametersResult(successful=False, reason=told[0])

    def _refuse_own_clock(self, settings: Settings, simulated: Any) -> None:
        """Refuse to follow a clock that is one's own: it would stand still."""
        if simulated and settings["publish_clock"]:
            msg = "publish_clock: got true together with use_sim_time, allowed is one or the other"
            raise RefusedError(msg)

    def _with(self, parameters: list[Parameter[Any]]) -> dict[str, Any]:
        changes = {each.name: each.value for each in parameters if each.name in DECLARATIONS}
        return {**self.course.settings.values, **changes}

    def _apply_parameters(self, parameters: list[Parameter[Any]]) -> None:
        with self._turn, self._mistakes_told("a change of parameters"):
            self.course.settle()
            settings = checked(self._with(parameters))
            self._outputs.publish_tf(settings["publish_tf"])
            self._recorder.limits = limits(settings)
            self.course.apply(settings)
            self._pacer.wake()
