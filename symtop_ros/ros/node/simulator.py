"""The standard interface of simulators, for programs that are written for any of them.

It is offered where the package simulation_interfaces is installed, under the names that Gazebo
gives it. One step is a period of publish_rate. A reset of the state goes back to the parameters
`initial.*`, and one of the time to 0 if the node owns the clock (publish_clock): another clock is
shared with others, and stays.

Versions of the package differ. Those before 2.1 (Humble, Jazzy, Kilted) have no flags in
SetEntityState for what is to be set, and some no code for an invalid pose.
"""

from collections import deque
from collections.abc import Callable, Generator
from typing import Any, cast

import numpy as np
from geometry_msgs.msg import Quaternion, Vector3
from rclpy.action.server import ActionServer, CancelResponse
from rclpy.node import Node
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Bounds, Result, SimulationState, SimulatorFeatures
from simulation_interfaces.srv import (
    GetEntities,
    GetEntityState,
    GetSimulationState,
    GetSimulatorFeatures,
    ResetSimulation,
    SetEntityState,
    SetSimulationState,
    StepSimulation,
)

from symtop_ros import __version__
from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError, one_line, refuse, vector
from symtop_ros.physics import State, angular_acceleration
from symtop_ros.run.session.session import Session
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.own_time import OwnTimeSimulation
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import MAX_RATE
from symtop_ros.run.wire.layout import NANOSECONDS

FEATURES = (
    SimulatorFeatures.ENTITY_STATE_GETTING,
    SimulatorFeatures.ENTITY_STATE_SETTING,
    SimulatorFeatures.SIMULATION_RESET,
    SimulatorFeatures.SIMULATION_RESET_STATE,
    SimulatorFeatures.SIMULATION_STATE_GETTING,
    SimulatorFeatures.SIMULATION_STATE_SETTING,
    SimulatorFeatures.SIMULATION_STATE_PAUSE,
    SimulatorFeatures.STEP_SIMULATION_SINGLE,
    SimulatorFeatures.STEP_SIMULATION_MULTIPLE,
    SimulatorFeatures.STEP_SIMULATION_ACTION,
)
INFO = f"symtop_ros {__version__}: one top"
STOPPED, PLAYING, PAUSED = (
    SimulationState.STATE_STOPPED,
    SimulationState.STATE_PLAYING,
    SimulationState.STATE_PAUSED,
)
ALL, TIME, STATE, SPAWNED = (
    ResetSimulation.Request.SCOPE_ALL,
    ResetSimulation.Request.SCOPE_TIME,
    ResetSimulation.Request.SCOPE_STATE,
    ResetSimulation.Request.SCOPE_SPAWNED,
)
TIME_IS_KEPT = "the state was reset; the time is not set back, as other programs share its clock"
UNSUPPORTED, FAILED = Result.RESULT_FEATURE_UNSUPPORTED, Result.RESULT_OPERATION_FAILED
INVALID_POSE: int = getattr(SetEntityState.Response, "INVALID_POSE", FAILED)
AT_REST = (0.0, 0.0, 0.0)
MAX_FILTER = 2**16  # bytes of a compiled filter; a larger one would keep the samples waiting


class ResultError(RefusedError):
    """A request that is refused with a code of the interface."""

    def __init__(self, code: int, refusal: RefusedError) -> None:
        super().__init__(str(refusal))
        self.code = code


class NextSpin:
    """To be awaited: the executor does its other work before it continues."""

    def __await__(self) -> Generator[None, None, None]:
        """Yield once."""
        yield


class Simulator:
    """The services and the action of the interface, next to those of the node."""

    def __init__(self, node: Node, session: Session, wake: Callable[[], None]) -> None:
        self._node, self._session, self._wake = node, session, wake
        self._simulation = session.simulation
        self._stopped: Segment | None = None  # what a stop has led to
        self._goals: deque[Any] = deque()  # of the action; the first one steps
        for kind, name, act in (
            (GetSimulatorFeatures, "get_simulator_features", self._get_features),
            (GetSimulationState, "get_simulation_state", self._get_state),
            (SetSimulationState, "set_simulation_state", self._set_state),
            (ResetSimulation, "reset_simulation", self._reset),
            (StepSimulation, "step_simulation", self._step),
            (GetEntities, "get_entities", self._get_entities),
            (GetEntityState, "get_entity_state", self._get_entity_state),
            (SetEntityState, "set_entity_state", self._set_entity_state),
        ):
            node.create_service(kind, f"~/{name}", self._handler(name, act))
        self._steps = ActionServer(
            node,
            SimulateSteps,
            "~/simulate_steps",
            self._simulate_steps,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def close(self) -> None:
        """Remove the action, which the node does not remove itself."""
        self._steps.destroy()

    def _handler(self, name: str, act: Callable[[Any, Any], str | None]) -> Any:
        """Return the handler of a service; `act` returns what is to be said of a success."""

        def handle(request: Any, response: Any) -> Any:
            def attempt() -> Result:
                try:
                    return Result(
                        result=Result.RESULT_OK, error_message=act(request, response) or ""
                    )
                except RefusedError as refusal:
                    return Result(
                        result=getattr(refusal, "code", FAILED), error_message=str(refusal)
                    )

            result = self._simulation.take_turn(f"~/{name}", attempt)
            if isinstance(result, Failure):
                result = Result(result=FAILED, error_message=str(result))
            if not isinstance(response, GetSimulatorFeatures.Response):  # it has no result
                response.result = result
            return response

        return handle

    def _demand(self, service: str, argument: Any) -> None:
        """Call one of the services of the top; raise RefusedError if it refuses."""
        granted, answer = self._session.answer(service, lambda: argument)
        self._wake()
        if not granted:
            raise RefusedError(answer)

    # The simulation

    def _get_features(self, _: Any, response: Any) -> None:
        owns_clock = isinstance(self._simulation, OwnTimeSimulation)
        features = [*FEATURES, *[SimulatorFeatures.SIMULATION_RESET_TIME] * owns_clock]
        response.features = SimulatorFeatures(features=features, custom_info=INFO)

    @property
    def _state(self) -> int:
        segment = self._simulation.segment
        if segment.running:
            return cast(int, PLAYING)
        return cast(int, STOPPED if segment is self._stopped else PAUSED)

    def _get_state(self, _: Any, response: Any) -> None:
        response.state.state = self._state

    def _set_state(self, request: Any, _: Any) -> None:
        target = request.state.state
        options = (STOPPED, PLAYING, PAUSED)
        if target not in options:
            raise ResultError(
                UNSUPPORTED, refuse("state", "0 (stopped), 1 (playing) or 2 (paused)", target)
            )
        if target == self._state:
            raise ResultError(
                SetSimulationState.Response.ALREADY_IN_TARGET_STATE,
                refuse("state", "different from the present one", target),
            )
        if self._simulation.segment.running != (target == PLAYING):
            self._demand("pause", target != PLAYING)
        self._stopped = None
        if target == STOPPED:
            self._demand("set_initial_conditions", {})
            self._stopped = self._simulation.segment

    def _reset(self, request: Any, _: Any) -> str:
        """Reset state and time, as the scope says and as far as they can be; nothing is spawned."""
        scope = request.scope or ALL
        simulation = self._simulation
        own_time = simulation if isinstance(simulation, OwnTimeSimulation) else None
        needed = STATE | TIME if own_time else STATE
        if not scope & needed or (scope != ALL and scope & ~(TIME | STATE | SPAWNED)):
            parts = f"the state ({STATE})" + f" or the time ({TIME})" * bool(own_time)
            raise ResultError(
                UNSUPPORTED,
                refuse("scope", f"one that includes {parts}, 0 or {ALL}", request.scope),
            )
        if own_time and scope & TIME:
            own_time.reset_time(with_state=bool(scope & STATE))
            self._wake()
            return ""
        self._demand("set_initial_conditions", {})
        return TIME_IS_KEPT if scope & TIME else ""

    def _step(self, request: Any, _: Any) -> None:
        if not request.steps:
            raise refuse("steps", "at least 1", 0)
        period = round(NANOSECONDS / self._simulation.ticker.rate)  # as a clock counts
        self._demand("step", {"duration": request.steps * period / NANOSECONDS})

    async def _simulate_steps(self, goal: Any) -> Any:
        """Carry out a goal when those before it have ended: each then advances by its own steps."""
        self._goals.append(goal)
        try:
            while self._goals[0] is not goal:
                if goal.is_cancel_requested:
                    goal.canceled()
                    return SimulateSteps.Result(result=Result(result=Result.RESULT_OK))
                await self._let_others_work()
            return await self._carry_out(goal)
        finally:
            self._goals.remove(goal)

    async def _carry_out(self, goal: Any) -> Any:
        """Step until all is done, a step is refused or the client cancels."""
        steps = goal.request.steps
        step = self._handler("simulate_steps", self._step)
        single = StepSimulation.Request(steps=min(steps, 1))  # 0 is refused
        for done in range(1, max(steps, 1) + 1):
            result = SimulateSteps.Result(result=step(single, StepSimulation.Response()).result)
            if result.result.result != Result.RESULT_OK:
                goal.abort()
                return result
            await self._tell(goal, done, steps - done)
            if goal.is_cancel_requested:
                goal.canceled()
                return result
        goal.succeed()
        return result

    async def _tell(self, goal: Any, done: int, left: int) -> None:
        """Send feedback to the clients, if they are still there."""
        feedback = SimulateSteps.Feedback(completed_steps=done, remaining_steps=left)
        try:
            goal.publish_feedback(feedback)
        except RuntimeError:
            if self._node.context.ok():
                raise
        await self._let_others_work()

    async def _let_others_work(self) -> None:
        """Let the executor do its other work, and then continue."""
        if self._node.executor:
            self._node.executor.wake()  # it sleeps until there is something to do
        await NextSpin()
        while not self._node.context.ok():  # ROS has ended, and the goal with it
            await NextSpin()

    # The top, the one entity

    @property
    def _name(self) -> str:
        return self._simulation.settings.top_frame

    def _get_entities(self, request: Any, response: Any) -> None:
        filters = request.filters
        if filters.categories or filters.tags.tags or filters.bounds.type != Bounds.TYPE_EMPTY:
            raise ResultError(UNSUPPORTED, refuse("filters", "a filter of names only", "others"))
        response.entities = [self._name] if _matches(filters.filter, self._name) else []

    def _check_name(self, entity: str) -> None:
        if entity != self._name:
            raise ResultError(Result.RESULT_NOT_FOUND, refuse("entity", f"'{self._name}'", entity))

    def _get_entity_state(self, request: Any, response: Any) -> None:
        self._check_name(request.entity)
        state = self._simulation.state
        found = response.state
        found.header.frame_id = self._simulation.settings.world_frame
        stamp = found.header.stamp
        stamp.sec, stamp.nanosec = divmod(self._simulation.stamp, NANOSECONDS)
        w, x, y, z = state.orientation.tolist()
        found.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
        found.twist.angular = _to_message(state.to_world(state.angular_velocity))
        found.acceleration.angular = _to_message(
            angular_acceleration(self._simulation.segment.motion, state)
        )

    def _set_entity_state(self, request: Any, _: Any) -> None:
        self._check_name(request.entity)
        given = request.state
        world = self._simulation.settings.world_frame
        # Without flags pose and twist are set, and the acceleration is ignored, as in Gazebo.
        if getattr(request, "set_acceleration", False):
            raise ResultError(
                UNSUPPORTED, refuse("set_acceleration", "false: it follows from the torque", True)
            )
        sets_pose = getattr(request, "set_pose", True)
        sets_twist = getattr(request, "set_twist", True)
        if given.header.frame_id not in ("", world):
            raise refuse("header.frame_id", f"'{world}'", given.header.frame_id)
        now = self._simulation.state
        attitude = _read_pose(given.pose) if sets_pose else now
        omega = _read_twist(given.twist) if sets_twist else now.to_world(now.angular_velocity)
        if sets_pose or sets_twist:
            w, x, y, z = attitude.orientation.tolist()
            self._demand(
                "set_initial_conditions",
                {
                    "orientation": [x, y, z, w],
                    "angular_velocity": attitude.to_body(omega).tolist(),
                },
            )


def _matches(pattern: str, name: str) -> bool:
    """Return True if a POSIX extended regular expression matches somewhere in a name.

    Python's `re` would take years for `'.?' * 60 + 'z'`, in which no other thread has a turn. RE2
    takes a time that is linear in pattern times name. Its memory is limited: without a limit
    `'[a-z]{1,1000}' * 70` took 9 s.
    """
    if not pattern:
        return True
    try:
        import re2  # noqa: PLC0415  # with apt's ROS it may be missing
    except ModuleNotFoundError:
        raise refuse(
            "filter", "empty without google-re2 (pip install google-re2)", pattern
        ) from None
    options = re2.Options()
    options.posix_syntax = options.one_line = True
    options.max_mem = MAX_FILTER
    options.log_errors = False
    try:
        return bool(re2.search(pattern, name, options))
    except (re2.error, UnicodeError) as error:
        reason = error.args[0]
        text = reason.decode(errors="replace") if isinstance(reason, bytes) else reason
        condition = f"a POSIX extended regular expression ({one_line(text)})"
        raise refuse("filter", condition, pattern) from None


def _to_message(vector: Any) -> Vector3:
    x, y, z = vector.tolist()
    return Vector3(x=x, y=y, z=z)


def _read_pose(pose: Any) -> State:
    """Return a state of rest with the orientation of a top, which turns about the pivot."""
    position = (pose.position.x, pose.position.y, pose.position.z)
    if position != AT_REST:
        raise ResultError(INVALID_POSE, refuse("position", "0 (the pivot is fixed)", position))
    q = pose.orientation
    try:
        return State((q.w, q.x, q.y, q.z), AT_REST)
    except ValueError as error:
        raise ResultError(INVALID_POSE, RefusedError(str(error))) from None


def _read_twist(twist: Any) -> Real:
    """Return omega in the world frame."""
    linear, omega = ((each.x, each.y, each.z) for each in (twist.linear, twist.angular))
    if linear != AT_REST:
        raise refuse("twist.linear", "0 (the pivot is fixed)", linear)
    return np.array(vector("twist.angular", omega, 3, MAX_RATE, "rad/s, world frame"))
