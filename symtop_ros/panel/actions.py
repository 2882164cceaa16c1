"""The acts of the page's users: each is a request of the interface, whatever top is behind it."""

import math
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.panel.run import Run
from symtop_ros.panel.source import Argument, Source
from symtop_ros.physics import Top
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.initial import FIELDS
from symtop_ros.simulation.presets import load_scene
from symtop_ros.simulation.settings import PARAMETERS
from symtop_ros.simulation.validation import RefusedError, number, reject

SCENE_PARAMETERS = ("top.", "initial.", "friction.", "steady_torque", "hurry_factor")
TOP_PARAMETERS = ("top.Ix", "top.Iz", "top.Mgl", "friction.axial", "friction.transverse")
LINKED = {name.rpartition(".")[2]: name for name in TOP_PARAMETERS}  # names in a link
WORDS = ("precession",)  # fields of a link that are no numbers
KEY_PUSH = 1.0  # rad/s by which an arrow key changes a rate, as in `top_ctl keys`
# Of the rate sqrt(|Mgl|/Ix) at which the hanging top swings: change of the rates across the axis by
# a pull of one scene unit.
PULL = 0.5
TORQUE_SHARE = 0.0075  # of |Mgl|: the torque of the buttons, 5e-4 N m for the article's top
STEPS = 24  # of a nutation
LONGEST_STEP = 0.05  # s of the motion; a nutation may be infinite


class Actions:
    """Requests to a top, with an answer that the page shows."""

    def __init__(self, source: Source, run: Run) -> None:
        self._source, self._run = source, run
        # reason of the last refusal, or another sentence for the user; empty after a success
        self.message = ""
        self._latest: dict[str, int] = {}
        self._lock = threading.Lock()

    def request(self, name: str, argument: Argument = None) -> str:
        """Send a request; return the answer, empty if it was refused."""
        granted, answer = self._source.request(name, argument)
        self.message = "" if granted else answer
        return answer if granted else ""

    def set_parameters(self, values: Mapping[str, Any]) -> bool:
        """Set parameters; return True if they were accepted."""
        granted, answer = self._source.set_parameters(values)
        self.message = "" if granted else answer
        return granted

    # What is done to the motion

    def hurry(self, factor: float) -> None:
        """Multiply the precession rate."""
        self.request("kick", {"precession_rate_factor": factor})

    def push_along(self, change: float) -> None:
        """Push the axle along its precession: a change of phi' in rad/s."""
        self.request("kick", {"precession_rate_change": change, "hold": "spin_momentum"})

    def push_tilt(self, change: float) -> None:
        """Push the axle up or down: an impulse about the line of nodes that changes theta'."""
        if self._run.state is not None and self._run.motion is not None:
            phi, size = self._run.state.euler_angles.phi, self._run.motion.top.Ix * change
            impulse = [size * math.cos(phi), size * math.sin(phi), 0.0]
            self.request("kick", {"angular_impulse": impulse})

    def pull(self, end: Real) -> None:
        """Kick by an arrow from the end of the axle to a point (3,) in scene units."""
        if self._run.state is not None and self._run.motion is not None:
            axis = self._run.state.to_world([0.0, 0.0, 1.0])
            impulse = impulse_of_pull(self._run.motion.top, axis, end)
            self.request("kick", {"angular_impulse": impulse.tolist()})

    def hold_torque(self, sign: float) -> None:
        """Apply a torque about the vertical until the next call or its time-out."""
        if self._run.motion is not None:
            size = TORQUE_SHARE * (abs(self._run.motion.top.Mgl) or self._run.motion.top.Ix)
            self._source.hold_torque((0.0, 0.0, sign * size))

    def toggle_pause(self) -> None:
        """Pause or resume."""
        segment = self._run.segment
        self.request("pause", bool(segment and segment.running))

    def step(self) -> None:
        """Advance by a part of a nutation; a running motion is paused first."""
        segment = self._run.segment
        if segment is None:
            return
        if segment.running:
            self.request("pause", True)
        period = segment.motion.nutation_period
        self.request("step", {"duration": min(period / STEPS, LONGEST_STEP)})

    def switch_recording(self) -> Path | None:
        """Begin a recording, or end it; return the path of a finished log on this machine."""
        begin = not self._run.is_recording
        answer = self.request("record", begin)
        if answer:
            self.message = answer  # it names the file
        return self._source.log if answer and not begin else None

    def set_speed(self, factor: float) -> None:
        """Set the real-time factor."""
        self.set_parameters({"real_time_factor": factor})

    # Starts

    def start(self, values: Mapping[str, Any]) -> None:
        """Restart from named initial conditions."""
        self.request("set_initial_conditions", values)

    def choose_scene(self, name: str) -> None:
        """Set the parameters of a scene and start it."""
        try:
            scene = load_scene(name)
        except RefusedError as refusal:
            self.message = str(refusal)
            return
        values = {
            key: scene.get(key, parameter.default)
            for key, parameter in PARAMETERS.items()
            if key.startswith(SCENE_PARAMETERS)
        }
        if self.set_parameters(values):
            self.start({})

    def restart_from(self, event: Event) -> None:
        """Restart from the state right after an event, with the top that it had."""
        motion, state = event.segment().motion, event.state()
        friction = (motion.friction.axial, motion.friction.transverse)
        values = dict(zip(TOP_PARAMETERS, (*motion.top.moments, *friction), strict=True))
        w, x, y, z = state.orientation.tolist()
        rates = state.angular_velocity.tolist()
        if self._set_top(values):
            self.start({"orientation": [x, y, z, w], "angular_velocity": rates})

    def follow_link(self, texts: Mapping[str, str]) -> None:
        """Start the experiment of a link: a scene, parameters of the top, initial conditions."""
        try:
            top, initial = read_link(texts)
        except RefusedError as refusal:
            self.message = str(refusal)
            return
        if "scene" in texts:
            self.choose_scene(texts["scene"])
            if self.message:
                return
        if (not top or self.set_parameters(top)) and (initial or top or not texts):
            self.start(initial)

    def _set_top(self, values: Mapping[str, float]) -> bool:
        motion = self._run.motion
        if motion is not None:
            friction = (motion.friction.axial, motion.friction.transverse)
            if tuple(values.values()) == (*motion.top.moments, *friction):
                return True
        return self.set_parameters(values)

    def last_of(self, kind: str, act: Callable[[], None], wait: Callable[[float], Any]) -> None:
        """Carry out the last of several acts of one kind: a slider that moves sends many."""
        with self._lock:
            ticket = self._latest[kind] = self._latest.get(kind, 0) + 1
        wait(0.12)
        if self._latest[kind] == ticket:
            act()


def impulse_of_pull(top: Top, axis: Real, end: Real) -> Real:
    """Return the angular impulse (3,) in N m s, world frame, of a pull at the end of the axle.

    It is axis x pull, as of a force at that end, times a size that suits the top.
    """
    rate = math.sqrt(abs(top.Mgl) / top.Ix) or 1.0
    return np.asarray(PULL * top.Ix * rate * np.cross(axis, end - axis))


def read_link(texts: Mapping[str, str]) -> tuple[dict[str, float], dict[str, Any]]:
    """Return parameters of the top and initial conditions of a link."""
    top: dict[str, float] = {}
    initial: dict[str, Any] = {}
    for name, text in texts.items():
        if name == "scene":
            continue
        if name in LINKED:
            top[LINKED[name]] = _read_number(name, text)
        elif name in FIELDS and name not in ("orientation", "angular_velocity"):
            initial[name] = text if name in WORDS else _read_number(name, text)
        else:
            known = [each for each in FIELDS if each not in ("orientation", "angular_velocity")]
            raise reject("name in a link", f"one of scene, {', '.join([*LINKED, *known])}", name)
    return top, initial


def write_link(run: Run) -> str:
    """Return the query of a link that starts the motion of the last event; empty without one.

    Its numbers have six digits: a link is typed and read by people.
    """
    if run.event is None or run.motion is None:
        return ""
    state, motion = run.motion.start, run.motion
    angles, rates = state.euler_angles, state.euler_rates
    friction = (motion.friction.axial, motion.friction.transverse)
    values = {
        **dict(zip(LINKED, (*motion.top.moments, *friction), strict=True)),
        **{name: getattr(angles, name) for name in ("theta", "phi", "psi")},
        **{f"{name}_dot": getattr(rates, name) for name in ("theta", "phi", "psi")},
    }
    return urlencode({name: f"{value:.6g}" for name, value in values.items()})


def _read_number(name: str, text: str) -> float:
    try:
        value: object = float(text)
    except ValueError:
        value = text
    return number(name, value, "rad, rad/s or the unit of the parameter")
