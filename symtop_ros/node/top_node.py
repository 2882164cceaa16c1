"""The node `top`: it keeps a run, publishes its samples on a steady grid and answers requests.

A request takes effect at the next stamp that is not published yet: samples before it belong to the
old motion, from it on to the new one.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator, Mapping
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
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from symtop_ros.node import initial, kick
from symtop_ros.node.applied_torque import AppliedTorque
from symtop_ros.node.diagnostics import diagnostics, state_report
from symtop_ros.node.effort import SHARE, Effort, Shortfall
from symtop_ros.node.fields import RefusedError, named_values, number, refuse
from symtop_ros.node.metadata import metadata
from symtop_ros.node.outputs import Outputs
from symtop_ros.node.pacer import Pacer
from symtop_ros.node.parameters import DECLARATIONS, Settings, checked, declare
from symtop_ros.node.ticker import CATCH_UP, Ticker
from symtop_ros.node.typed_requests import with_known_types
from symtop_ros.node.urdf import robot_description
from symtop_ros.physics import State, motion, perry
from symtop_ros.physics.perry import kick_verdict
from symtop_ros.recording.recorder import Limits, Recorder, reason
from symtop_ros.run.block import Block
from symtop_ros.run.events import PREFIX, Event
from symtop_ros.run.segment import Segment
from symtop_ros.wire.diagnostics import OK, Status, packed

LONGEST_STEP = 1e9  # s
STEPS_OF_A_STEP = 20_000  # of the engine: nobody else has a turn for half a second
AHEAD = 0.05  # s of samples that are computed at once; a kick makes them void
AT_ONCE, AT_ONCE_DRIVEN = 16, 4  # of them at most: the engine's work is parted in small pieces
SECOND = 1_000_000_000
JUMP = 1.0  # s; a clock that is set further than this has jumped
SIM_TIME = "use_sim_time"
CLOCK_CHANGES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)


class TopNode(Node):
    """A heavy symmetric top in real time; topics, services and parameters as in the README.

    Ticks come from a thread of the node's own, requests from the executor; they take turns.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("top", **options)
        self._settings = declare(self)
        self._refuse_own_clock(self.get_parameter(SIM_TIME).value)
        start = initial.initial_state(self._settings.top, self._settings.initial, {})
        self._turn = threading.RLock()
        self._failure_told = False
        self._recorder = Recorder(Path(self._settings["record.directory"]), self._limits())
        frames = self._settings["world_frame"], self._settings["top_frame"]
        self._outputs = Outputs(self, self._recorder, *frames, self._settings["publish_clock"])
        self._outputs.publish_tf(self._settings["publish_tf"])
        self._ticker = Ticker(self._settings["publish_rate"], self._now())
        self._initial = start
        self._torque = AppliedTorque(self._frame)
        self._effort, self._spent = Effort(self._ticker.next_stamp), 0.0
        self._segment = Segment.begin(
            motion(
                self._settings.top, start, self._settings.friction, self._settings.steady_torque
            ),
            self._ticker.next_stamp,
            self._settings["real_time_factor"],
        )
        self._block = Block(self._segment, [])
        self._describe()
        self._announce("start", self._verdict(), {"scene": self._scene}, start)
        if self._settings["record.enabled"]:
            self._begin_log()
        self._offer_services()
        self.create_subscription(WrenchStamped, "~/applied_torque", self._take_torque, 10)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        self.create_timer(1.0, self._diagnose)
        self.get_logger().info(f"scene {self._scene}: {self._verdict()}")
        self.failure: Exception | None = None
        self._jumped_to: int | None = None
        self._pacer = Pacer(self._tick, self._fail)
        self._follow_clock()

    def close(self) -> None:
        """End the ticks and the log; the node can go."""
        self._pacer.stop()
        self._recorder.stop()

    def destroy_node(self) -> None:
        """Close, and take the node from the graph; rclpy does so too where none was made."""
        if hasattr(self, "_pacer"):
            self.close()
        super().destroy_node()

    def create_service(self, *arguments: Any, **options: Any) -> Any:
        """Offer a service; rclpy makes its own, for parameters, by this too."""
        kind, name, handle, *others = arguments
        return super().create_service(
            kind, name, with_known_types(kind, handle), *others, **options
        )

    # time

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _tick(self) -> float | None:
        """Publish what is due; return how long nothing will be, None where the clock will tell."""
        with self._turn:
            jumped_to, self._jumped_to = self._jumped_to, None
            if self._now() < self._ticker.next_stamp - (JUMP + 1 / self._ticker.rate) * SECOND:
                jumped_to = self._now()  # the clock of the system, which tells nobody
            if jumped_to is not None:
                self._follow_jump(jumped_to)
            self._release_torque()
            if not self._publish_ready() or not self._prepare_block():
                return 0.0
            wait = (self._ticker.next_stamp - self._now()) / SECOND
            return None if self._simulated and wait > 0 else wait

    @property
    def _simulated(self) -> bool:
        return cast(ROSClock, self.get_clock()).ros_time_is_active

    def _publish_ready(self) -> bool:
        """Publish what is due; return whether it was prepared."""
        ready = self._prepare_block()
        if ready:
            self._publish_due()
        return ready

    def _publish_due(self) -> None:
        missed, catch_up = self._ticker.missed, JUMP if self._simulated else CATCH_UP
        for stamp in self._ticker.due(self._now(), catch_up, self._block.last):
            self._outputs.send_sample(stamp, self._block)
        if self._ticker.missed > missed:
            self._tell_gap(self._ticker.missed - missed)

    def _prepare_block(self) -> bool:
        """Have the samples of the next stamps at hand; return whether they are."""
        stamp, segment = self._ticker.next_stamp, self._segment
        if self._block.holds(segment, stamp):
            return True
        stamps = self._ticker.grid(stamp, self._length_of_block())
        if any(self._torque.value):
            stamps = [each for each in stamps if each < self._torque.end]
        if not stamps:  # it ends with the next turn
            return False
        ready = self._effort.prepare(segment, stamps[-1])
        if ready:
            self._block = self._block.following(segment, stamps)
        elif self._effort.shortfall:
            self._slow_down(stamp, self._effort.shortfall)
        return ready

    def _length_of_block(self) -> int:
        """Few samples where a motion begins, so that its first one comes soon, then more."""
        segment, rate = self._segment, self._ticker.rate
        most = AT_ONCE_DRIVEN if segment.path.driven else AT_ONCE
        grown = 4 * self._block.length if self._block.segment is segment else 1
        return max(1, min(most, grown, int(AHEAD * rate)))

    def _settle(self) -> None:
        """Begin the turn of a request: the state that it finds is at hand."""
        self._release_torque()
        self._keep_up(self._ticker.next_stamp)

    def _keep_up(self, stamp: int) -> None:
        """Have the state at a stamp at hand; a motion that is too fast for it is slowed down."""
        while not self._effort.prepare(self._segment, stamp):
            if self._effort.shortfall:
                self._slow_down(stamp, self._effort.shortfall)

    def _slow_down(self, stamp: int, shortfall: Shortfall) -> None:
        reached, factor = shortfall
        asked, before = self._segment.factor, self._segment.path.at(reached)
        self._segment = self._segment.slowed(reached, factor, stamp)
        verdict = f"the engine cannot keep up: real-time factor {asked:.3g} -> {factor:.3g}"
        self.get_logger().warning(verdict)
        self._announce("pace", verdict, {"reached": reached}, before, stamp)

    def _speed_up(self, work: float) -> None:
        """Go back towards the real-time factor that is asked for, where there is time for it."""
        now, asked = self._segment.factor, self._settings["real_time_factor"]
        if now < asked and work < SHARE / 2:
            stamp = self._ticker.next_stamp
            factor = min(asked, 2 * now) if self._segment.path.driven else asked
            before = self._segment.state_at(stamp)
            self._segment = self._segment.with_factor(factor, stamp)
            self._announce("pace", f"real-time factor {now:.3g} -> {factor:.3g}", {}, before)

    def _tell_gap(self, missed: int) -> None:
        seconds = missed / self._settings["publish_rate"]
        self.get_logger().warning(
            f"no samples for {seconds:.3g} s: the process was stopped, or has too little time; "
            f"{missed} samples are missed, the motion is where the clock says",
            throttle_duration_sec=1.0,
        )

    def _fail(self, error: Exception) -> None:
        """End the node when a tick cannot be done; a context that has ended is no failure."""
        if self.context.ok():
            self.failure = error
            self.get_logger().fatal(f"a tick failed: {error}")
            self.context.try_shutdown()

    def _diagnose(self) -> None:
        with self._turn:
            self._settle()
            work, self._spent = self._effort.spent - self._spent, self._effort.spent
            self._speed_up(work)
            self._report_failure()
            output = self._outputs.diagnostics
            if output.wanted:
                stamp = self._ticker.next_stamp
                facts = self._segment, stamp, self._ticker, self._recorder
                output.send(stamp, packed(stamp, self._frame, diagnostics(self._settings, *facts)))

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
            self._jumped_to = self._now()
        self._pacer.wake()

    def _follow_jump(self, now: int) -> None:
        """A clock that jumps takes the motion along from where it is."""
        stamp = self._ticker.next_stamp
        self._keep_up(stamp)
        before = self._segment.state_at(stamp)
        self._segment = self._segment.moved(stamp, now)
        self._ticker.restart(self._settings["publish_rate"], now)
        self._torque.end += now - stamp
        self._announce("clock", "the clock has jumped", {"from": stamp, "to": now}, before)

    # the applied torque

    def _take_torque(self, message: WrenchStamped) -> None:
        with self._turn:
            self._settle()
            stamp = self._ticker.next_stamp
            try:
                self._torque.hold(message, stamp, self._settings["applied_torque_timeout"])
            except RefusedError as refusal:
                self.get_logger().warning(str(refusal), throttle_duration_sec=1.0)
            else:
                self._drive(stamp, "an applied torque acts")

    def _release_torque(self) -> None:
        if any(self._torque.value) and self._ticker.next_stamp >= self._torque.end:
            self._keep_up(self._torque.end)
            self._torque.release()
            self._drive(self._torque.end, "the applied torque has run out")

    def _drive(self, stamp: int, verdict: str) -> None:
        """Go on from a stamp under the torque that acts now, if it is another one."""
        steady, held = self._settings.steady_torque, self._torque.value
        torque = tuple(a + b for a, b in zip(steady, held, strict=True))
        if torque != self._segment.path.applied_torque:
            before = self._segment.state_at(stamp)
            self._segment = self._segment.changed(stamp, torque=torque)
            self._announce("torque", verdict, {"torque": torque}, before, stamp)

    # events and answers

    @property
    def _frame(self) -> str:
        return str(self._settings["world_frame"])

    @property
    def _scene(self) -> str:
        return str(self.get_parameter("scene").value)

    def _verdict(self) -> str:
        path = self._segment.path
        return f"{path.kind}: {perry(path.top, path.start)}"

    def _describe(self) -> None:
        frames = self._settings["world_frame"], self._settings["top_frame"]
        text = robot_description(self._settings.top, *frames)
        self._outputs.description.send_message(self._ticker.next_stamp, String(data=text))

    def _announce(
        self,
        name: str,
        verdict: str,
        request: Mapping[str, Any],
        before: State,
        stamp: int | None = None,
    ) -> None:
        stamp = self._ticker.next_stamp if stamp is None else stamp
        event = Event.of(stamp, name, verdict, request, before, self._segment)
        status = Status(stamp, OK, PREFIX + name, verdict, event.values)
        self._outputs.events.send(stamp, packed(stamp, self._frame, [status]))

    def _offer_services(self) -> None:
        for name, kind, handle in (
            ("set_initial_conditions", SetParametersAtomically, self._set_initial_conditions),
            ("kick", SetParametersAtomically, self._kick),
            ("step", SetParametersAtomically, self._step),
            ("hurry_precession", Trigger, self._hurry_precession),
            ("reset", Trigger, self._reset),
            ("pause", SetBool, self._pause),
            ("record", SetBool, self._record),
            ("get_state", Trigger, self._get_state),
        ):
            self.create_service(kind, f"~/{name}", self._answering(handle))

    def _answering(self, handle: Any) -> Any:
        """Turn a sentence or a refusal into the response of any of the service types.

        What is due by then is published at once, and need not wait for the pacer's turn.
        """

        def answer(request: Any, response: Any) -> Any:
            with self._turn:
                self._settle()
                try:
                    granted, sentence = True, handle(request)
                except RefusedError as refusal:
                    granted, sentence = False, str(refusal)
                self._tick()
            if isinstance(response, SetParametersAtomically.Response):
                response.result = SetParametersResult(successful=granted, reason=sentence)
            else:
                response.success, response.message = granted, sentence
            return response

        return answer

    # what requests do: each returns the sentence of its answer, or raises RefusedError

    def _set_initial_conditions(self, request: SetParametersAtomically.Request) -> str:
        values = named_values(request.parameters, initial.NAMES)
        start = initial.initial_state(self._settings.top, self._settings.initial, values)
        self._initial = start
        return self._restart("start", values, start)

    def _reset(self, _: Trigger.Request) -> str:
        return self._restart("reset", {}, self._initial)

    def _restart(self, name: str, request: Mapping[str, Any], start: State) -> str:
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        with self._at_once(self._segment.restarted(start, stamp)):
            verdict = self._verdict()
            self._publish_ready()
            self._announce(name, verdict, request, before, stamp)
        return verdict

    def _kick(self, request: SetParametersAtomically.Request) -> str:
        return self._kick_by(named_values(request.parameters, kick.NAMES))

    def _hurry_precession(self, _: Trigger.Request) -> str:
        return self._kick_by({"precession_rate_factor": self._settings["hurry_factor"]})

    def _kick_by(self, values: Mapping[str, Any]) -> str:
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        path, hold = kick.kicked(self._segment.path, before, values)
        with self._at_once(self._segment.onto(path, stamp)):
            verdict = kick_verdict(path, before, hold)
            self._publish_ready()
            self._announce("kick", verdict, values, before, stamp)
        return verdict

    @contextmanager
    def _at_once(self, segment: Segment) -> Iterator[None]:
        """Go on with another segment, and publish its first sample before there are words for it.

        In the log its event comes first all the same.
        """
        self._segment = segment
        with self._recorder.behind(self._outputs.events.channel):
            self._publish_ready()
            yield

    def _pause(self, request: SetBool.Request) -> str:
        stamp, pausing = self._ticker.next_stamp, bool(request.data)
        if pausing != self._segment.running:
            return "paused already" if pausing else "running already"
        before = self._segment.state_at(stamp)
        change = self._segment.paused if pausing else self._segment.resumed
        self._segment = change(stamp)
        name = "pause" if pausing else "resume"
        verdict = f"{name}d at {self._segment.elapsed:.6f} s of the motion"
        self._announce(name, verdict, {}, before)
        return verdict

    def _step(self, request: SetParametersAtomically.Request) -> str:
        values = named_values(request.parameters, ("duration",))
        if "duration" not in values:
            msg = "duration: got none, allowed is a number of seconds"
            raise RefusedError(msg)
        duration = number("duration", values["duration"], 0.0, LONGEST_STEP)
        if self._segment.running:
            msg = "step: got it while running, allowed is while paused (~/pause)"
            raise RefusedError(msg)
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        end = self._segment.elapsed + duration
        reached = self._segment.path.reach(end, STEPS_OF_A_STEP)
        if reached != end:
            most = reached - self._segment.elapsed
            allowed = f"up to {most:.6g} s at a time under friction or an applied torque"
            raise refuse("duration", duration, allowed)
        self._segment = self._segment.stepped(duration, stamp)
        verdict = f"stepped to {self._segment.elapsed:.6f} s of the motion"
        self._announce("step", verdict, values, before)
        return verdict

    def _record(self, request: SetBool.Request) -> str:
        path = self._recorder.path
        if bool(request.data) == bool(path):
            return f"recording already, to {path}" if path else "not recording"
        if path:
            self._note_log(f"recording to {path} ended")
            self._recorder.stop()
            return f"recorded to {path}"
        path = self._begin_log()
        self._note_log(f"recording to {path}")
        return f"recording to {path}"

    def _get_state(self, _: Trigger.Request) -> str:
        return json.dumps(state_report(self._segment, self._ticker.next_stamp))

    # the log

    def _limits(self) -> Limits:
        return Limits(self._settings["record.max_size"], self._settings["record.max_duration"])

    def _begin_log(self) -> Path:
        try:
            path = self._recorder.start(metadata(self._scene, self._settings.values, self._now()))
        except (OSError, ImportError) as error:
            msg = f"record: no log in {self._settings['record.directory']!r}: {reason(error)}"
            raise RefusedError(msg) from None
        self.get_logger().info(f"recording to {path}")
        return path

    def _note_log(self, sentence: str) -> None:
        before = self._segment.state_at(self._ticker.next_stamp)
        self._announce("record", sentence, {}, before)

    def _report_failure(self) -> None:
        """Say once that a recording has ended by itself; the motion goes on."""
        if self._recorder.failure and not self._failure_told:
            sentence = f"recording stopped: {self._recorder.failure}"
            self.get_logger().error(sentence)
            self._note_log(sentence)
        self._failure_told = bool(self._recorder.failure)

    # parameters

    def _check_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        try:
            checked(self._with(parameters))
            self._refuse_own_clock(any(each.name == SIM_TIME and each.value for each in parameters))
        except RefusedError as refusal:
            return SetParametersResult(successful=False, reason=str(refusal))
        return SetParametersResult(successful=True)

    def _refuse_own_clock(self, simulated: Any) -> None:
        """Refuse to follow a clock that is one's own: it would stand still."""
        if simulated and self._settings["publish_clock"]:
            msg = "publish_clock: got true together with use_sim_time, allowed is one or the other"
            raise RefusedError(msg)

    def _with(self, parameters: list[Parameter[Any]]) -> dict[str, Any]:
        changes = {each.name: each.value for each in parameters if each.name in DECLARATIONS}
        return {**self._settings.values, **changes}

    def _apply_parameters(self, parameters: list[Parameter[Any]]) -> None:
        with self._turn:
            self._settle()
            old, self._settings = self._settings, checked(self._with(parameters))
            changes = {
                name: value for name, value in self._settings.values.items() if value != old[name]
            }
            if changes:
                self._apply(old, changes)

    def _apply(self, old: Settings, changes: Mapping[str, Any]) -> None:
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        settings = self._settings
        if (settings.top, settings.friction) != (old.top, old.friction):
            self._segment = self._segment.changed(stamp, settings.top, settings.friction)
        if settings.top != old.top:
            self._describe()
        self._outputs.publish_tf(settings["publish_tf"])
        self._recorder.limits = self._limits()
        if "real_time_factor" in changes:
            self._segment = self._segment.with_factor(settings["real_time_factor"], stamp)
        if "publish_rate" in changes:
            self._ticker.restart(settings["publish_rate"], stamp)
            self._block = Block(self._segment, [])  # of the old grid
            self._pacer.wake()
        verdict = "; ".join(f"{name} is now {value}" for name, value in changes.items())
        self._announce("parameters", verdict, changes, before)
        if settings.steady_torque != old.steady_torque:
            self._drive(stamp, "the steady torque is another one")
