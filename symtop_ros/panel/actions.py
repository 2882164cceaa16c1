"""The acts of the page's users: each is a request of the interface, whatever top is behind it.

A request that is refused raises RefusedError, whose text the user reads.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.panel.source import Argument, Source
from symtop_ros.physics import Top
from symtop_ros.simulation.changes.initial import FIELDS
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.presets import load_scene
from symtop_ros.simulation.settings import PARAMETERS
from symtop_ros.simulation.validation import RefusedError, number, reject
from symtop_ros.web.facts import TOP_PARAMETERS, top_parameters
from symtop_ros.web.run import Run

SCENE_PARAMETERS = ("top.", "initial.", "friction.", "steady_torque", "hurry_factor")
LINKED = {name.rpartition(".")[2]: name for name in TOP_PARAMETERS}  # names in a link
WORDS = ("precession",)  # fields of a link that are no numbers
PUSH = 1.0  # rad/s by which an arrow key changes a rate, as in `top_ctl keys`
# Of the rate sqrt(|Mgl|/Ix) at which the hanging top swings: change of the rates across the axis by
# a pull of one scene unit.
PULL = 0.5
TORQUE_SHARE = 0.0075  # of |Mgl|: the torque of the buttons, 5e-4 N m for the article's top
STEPS = 24  # of a nutation
LONGEST_STEP = 0.05  # s of the motion; a nutation may be infinite


class Actions:
    """Requests to a top."""

    def __init__(self, source: Source, run: Run) -> None:
        self._source, self._run = source, run

    def request(self, name: str, argument: Argument = None) -> str:
        """Send a request; return the answer."""
        return _grant(*self._source.request(name, argument))

    def set_parameters(self, values: Mapping[str, Any]) -> None:
        """Set parameters, all or none."""
        _grant(*self._source.set_parameters(values))

    # What is done to the motion

    def kick(self, factor: float, hold: object = None) -> None:
        """Multiply the precession rate, with psi' held or what is named."""
        held = {} if hold is None else {"hold": hold}
        self.request("kick", {"precession_rate_factor": factor, **held})

    def push(self, way: str) -> None:
        """Push the axle up or down, along its precession or back."""
        if way in ("up", "down"):
            self.push_tilt(-PUSH if way == "up" else PUSH)
        elif way in ("along", "back"):
            change = PUSH if way == "along" else -PUSH
            self.request("kick", {"precession_rate_change": change, "hold": "spin_momentum"})
        else:
            raise reject("way", "up, down, along or back", way)

    def push_tilt(self, change: float) -> None:
        """Push the axle by an impulse about the line of nodes that changes theta' (rad/s)."""
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
            self._source.hold_torque((0.0, 0.0, math.copysign(size, sign)))

    def toggle_pause(self) -> None:
        """Pause or resume."""
        segment = self._run.segment
        self.request("pause", bool(segment and segment.running))

    def pause(self) -> None:
        """Pause a running motion."""
        if self._run.segment is None or self._run.segment.running:
            self.request("pause", True)

    def rest(self) -> None:
        """Pause for a page that prefers no motion; a node has others who watch it."""
        if self._source.is_own:
            self.pause()

    def step(self) -> None:
        """Advance by a part of a nutation; a running motion is paused first."""
        segment = self._run.segment
        if segment is None:
            return
        self.pause()
        period = segment.motion.nutation_period
        self.request("step", {"duration": min(period / STEPS, LONGEST_STEP)})

    def switch_recording(self) -> tuple[str, Path | None]:
        """Begin or end a recording; return the answer, and a finished log on this machine."""
        begin = not self._run.is_recording
        answer = self.request("record", begin)
        return answer, None if begin else self._source.log

    # Starts

    def start(self, values: Mapping[str, Any]) -> None:
        """Restart from named initial conditions."""
        self.request("set_initial_conditions", values)

    def choose_scene(self, name: str) -> None:
        """Set the parameters of a scene and start it."""
        self._set_scene(name)
        self.start({})

    def _set_scene(self, name: str) -> None:
        scene = load_scene(name)
        self.set_parameters(
            {
                key: scene.get(key, parameter.default)
                for key, parameter in PARAMETERS.items()
                if key.startswith(SCENE_PARAMETERS)
            }
        )

    def restart_from(self, event: Event) -> None:
        """Restart from the state right after an event, with the top that it had."""
        values, state = top_parameters(event.segment().motion), event.state()
        if self._run.motion is None or top_parameters(self._run.motion) != values:
            self.set_parameters(values)
        w, x, y, z = state.orientation.tolist()
        rates = state.angular_velocity.tolist()
        self.start({"orientation": [x, y, z, w], "angular_velocity": rates})

    def follow_link(self, texts: Mapping[str, str]) -> None:
        """Start the experiment of a link: a scene, parameters of the top, initial conditions."""
        top, initial = read_link(texts)
        if "scene" in texts:
            self._set_scene(texts["scene"])
        if top:
            self.set_parameters(top)
        self.start(initial)


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


def _read_number(name: str, text: str) -> float:
    try:
        value: object = float(text)
    except ValueError:
        value = text
    return number(name, value, "rad, rad/s or the unit of the parameter")


def _grant(granted: bool, answer: str) -> str:
    if not granted:
        raise RefusedError(answer)
    return answer
