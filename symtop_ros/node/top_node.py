"""The node `top`: it keeps a run, publishes its samples on a steady grid and answers requests.

A request takes effect at the next stamp that is not published yet: samples before it belong to the
old motion, from it on to the new one.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from symtop_ros.node import initial, kick
from symtop_ros.node.diagnostics import diagnostics, state_report
from symtop_ros.node.fields import RefusedError, named_values, number
from symtop_ros.node.messages import event_message
from symtop_ros.node.metadata import metadata
from symtop_ros.node.outputs import Outputs
from symtop_ros.node.parameters import DECLARATIONS, Settings, checked, declare
from symtop_ros.node.ticker import Ticker
from symtop_ros.node.urdf import robot_description
from symtop_ros.physics import State, perry
from symtop_ros.recording.recorder import Limits, Recorder, reason
from symtop_ros.run.events import Event
from symtop_ros.run.segment import Segment

LONGEST_STEP = 1e9  # s


class TopNode(Node):
    """A heavy symmetric top in real time; topics, services and parameters as in the README."""

    def __init__(self, **options: Any) -> None:
        super().__init__("top", **options)
        self._settings = declare(self)
        if self._settings["publish_clock"] and self.get_parameter("use_sim_time").value:
            msg = "publish_clock: got true together with use_sim_time, allowed is one or the other"
            raise RefusedError(msg)
        start = initial.initial_state(self._settings.top, self._settings.initial, {})
        self._failure_told = False
        self._recorder = Recorder(Path(self._settings["record.directory"]), self._limits())
        frames = self._settings["world_frame"], self._settings["top_frame"]
        self._outputs = Outputs(self, self._recorder, *frames, self._settings["publish_clock"])
        self._outputs.publish_tf(self._settings["publish_tf"])
        self._ticker = Ticker(self._settings["publish_rate"], self._now())
        self._initial = start
        self._segment = Segment.begin(
            self._settings.top, start, self._ticker.next_stamp, self._settings["real_time_factor"]
        )
        self._describe()
        self._announce("start", self._verdict(), {"scene": self._scene}, start)
        if self._settings["record.enabled"]:
            self._begin_log()
        self._offer_services()
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        self._timer = self.create_timer(1 / self._settings["publish_rate"], self._tick)
        self.create_timer(1.0, self._diagnose)
        self._follow_jumps()
        self.get_logger().info(f"scene {self._scene}: {self._verdict()}")

    # time

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _tick(self) -> None:
        segment = self._segment
        for stamp in self._ticker.due(self._now()):
            self._outputs.send_sample(stamp, segment.path.top, segment.state_at)

    def _diagnose(self) -> None:
        self._report_failure()
        output = self._outputs.diagnostics
        if output.wanted:
            stamp = self._ticker.next_stamp
            facts = self._segment, stamp, self._ticker, self._recorder
            output.send_message(stamp, diagnostics(self._settings["world_frame"], *facts))

    def _follow_jumps(self) -> None:
        """A clock that jumps (simulation time) takes the motion along from where it is."""
        threshold = JumpThreshold(
            min_forward=Duration(seconds=1),
            min_backward=Duration(nanoseconds=-1),
            on_clock_change=True,
        )
        clock = self.get_clock()
        self._jumps = clock.create_jump_callback(threshold, post_callback=self._jumped)

    def _jumped(self, _: TimeJump) -> None:
        stamp, now = self._ticker.next_stamp, self._now()
        before = self._segment.state_at(stamp)
        self._segment = self._segment.moved(stamp, now)
        self._ticker.restart(self._settings["publish_rate"], now)
        self._announce("clock", "the clock has jumped", {"from": stamp, "to": now}, before)

    # events and answers

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

    def _announce(self, name: str, verdict: str, request: Mapping[str, Any], before: State) -> None:
        stamp = self._ticker.next_stamp
        event = Event.of(stamp, name, verdict, request, before, self._segment)
        self._outputs.events.send_message(
            stamp, event_message(event, self._settings["world_frame"])
        )

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
            self.create_service(kind, f"~/{name}", _answering(handle))

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
        self._segment = self._segment.restarted(start, stamp)
        verdict = self._verdict()
        self._announce(name, verdict, request, before)
        return verdict

    def _kick(self, request: SetParametersAtomically.Request) -> str:
        return self._kick_by(named_values(request.parameters, kick.NAMES))

    def _hurry_precession(self, _: Trigger.Request) -> str:
        return self._kick_by({"precession_rate_factor": self._settings["hurry_factor"]})

    def _kick_by(self, values: Mapping[str, Any]) -> str:
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        after, verdict = kick.kicked(self._segment.path.top, before, values)
        self._segment = self._segment.restarted(after, stamp)
        self._announce("kick", verdict, values, before)
        return verdict

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

    def close(self) -> None:
        """End the log; the node can go."""
        self._recorder.stop()

    # parameters

    def _check_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        try:
            checked(self._with(parameters))
        except RefusedError as refusal:
            return SetParametersResult(successful=False, reason=str(refusal))
        return SetParametersResult(successful=True)

    def _with(self, parameters: list[Parameter[Any]]) -> dict[str, Any]:
        changes = {each.name: each.value for each in parameters if each.name in DECLARATIONS}
        return {**self._settings.values, **changes}

    def _apply_parameters(self, parameters: list[Parameter[Any]]) -> None:
        old, self._settings = self._settings, checked(self._with(parameters))
        changes = {
            name: value for name, value in self._settings.values.items() if value != old[name]
        }
        if changes:
            self._apply(old, changes)

    def _apply(self, old: Settings, changes: Mapping[str, Any]) -> None:
        stamp = self._ticker.next_stamp
        before = self._segment.state_at(stamp)
        if self._settings.top != old.top:
            self._segment = self._segment.with_top(self._settings.top, stamp)
            self._describe()
        self._outputs.publish_tf(self._settings["publish_tf"])
        self._recorder.limits = self._limits()
        factor = self._settings["real_time_factor"]
        self._segment = self._segment.with_factor(factor, stamp)
        if "publish_rate" in changes:
            self._ticker.restart(self._settings["publish_rate"], stamp)
            self._timer.timer_period_ns = int(1e9 / self._settings["publish_rate"])
            self._timer.reset()
        verdict = "; ".join(f"{name} is now {value}" for name, value in changes.items())
        self._announce("parameters", verdict, changes, before)


def _answering(handle: Any) -> Any:
    """Turn a sentence or a refusal into the response of any of the service types."""

    def answer(request: Any, response: Any) -> Any:
        try:
            granted, sentence = True, handle(request)
        except RefusedError as refusal:
            granted, sentence = False, str(refusal)
        if isinstance(response, SetParametersAtomically.Response):
            response.result = SetParametersResult(successful=granted, reason=sentence)
        else:
            response.success, response.message = granted, sentence
        return response

    return answer
