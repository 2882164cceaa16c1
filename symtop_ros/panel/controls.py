"""The controls of the page: what a user can press, move and choose, and what it says."""

import math
import re
import time
from collections.abc import Callable
from functools import partial
from html import escape
from typing import Any

import imageio.v3 as iio
from viser import (
    ClientHandle,
    GuiButtonGroupHandle,
    GuiButtonHandle,
    GuiCheckboxHandle,
    GuiEvent,
    GuiNumberHandle,
    GuiSliderHandle,
    Icon,
    ViserServer,
)

from symtop_ros.panel.actions import (
    KEY_PUSH,
    TOP_PARAMETERS,
    Actions,
    write_link,
)
from symtop_ros.panel.run import Run
from symtop_ros.panel.scene import LAYERS, Scene
from symtop_ros.physics import regular_precession_rates
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.segment import Segment

Act = Callable[[], Any]
LISTED = 10  # entries of the history
WIDTH = 318  # px
SLOWEST, FASTEST = -2.0, 0.0  # decades of the real-time factor
NUMBER = re.compile(r"-?\d+\.\d+(e[-+]?\d+)?")
SPEEDS = ((-2.0, "1/100"), (-1.0, "1/10"), (0.0, "1"))
SPIN = 400.0  # rad/s: range of the slider of psi' at least
LEAST_RATE = 12.0  # rad/s: range of the slider of phi' at least
FACTOR = 1.4
BRAND, SLATE = (43, 120, 228), (96, 116, 148)
PUSHES = """\
Pull the **ball** at the end of the axle with the mouse: the arrow is the angular impulse that the \
top gets when you let go.

| key | |
|---|---|
| h, d | hurry, delay |
| space, r | pause, reset |
| arrows | push the axle |

A torque about the vertical acts while its button is held. It does not hurry the precession: \
it raises the top.
"""
NUMBERS = {  # label and step of each parameter of the top
    "top.Ix": ("Ix (kg m\u00b2)", 1e-6),
    "top.Iz": ("Iz (kg m\u00b2)", 1e-7),
    "top.Mgl": ("Mgl (J)", 1e-3),
    "friction.axial": ("friction axial", 1e-7),
    "friction.transverse": ("friction across", 1e-7),
}


class Controls:
    """The panel on the left of the page."""

    def __init__(self, server: ViserServer, actions: Actions, run: Run, scene: Scene) -> None:
        self._gui, self._actions, self._run, self._scene = server.gui, actions, run, scene
        self._marked: tuple[float, ...] = ()  # regular rates on the slider of phi'
        self._sent: str | None = None  # start that the sliders asked for, as in its event
        _configure(server, dark=False)
        server.gui.main_panel.dock_left()
        server.gui.main_panel.set_width(WIDTH)
        self._verdict = server.gui.add_html("")
        self._add_acts()
        tabs = server.gui.add_tab_group()
        with tabs.add_tab("Top"):
            self._add_start()
        with tabs.add_tab("Push"):
            self._add_pushes()
        with tabs.add_tab("History"):
            self._entries = [self._add_entry(k) for k in range(LISTED)]
        with tabs.add_tab("View"):
            self._add_layers()
        with tabs.add_tab("Save"):
            self._add_saving()
        self._add_keys()

    # What the page says

    def write(self) -> None:
        """Write the verdict, the message, the history, and the link of the motion."""
        run, segment = self._run, self._run.segment
        self._verdict.content = self._write_verdict(segment)
        if segment is None:
            return
        self._record.label = "End the recording" if run.is_recording else "Record (MCAP)"
        self._others.options = ("Delay", "Pause" if segment.running else "Run", "Step", "Reset")
        for entry, event in zip(self._entries, self._list_history(), strict=False):
            entry.label, entry.visible = _describe(event), True
        for entry in self._entries[len(run.history) :]:
            entry.visible = False
        _set(self._link, f"/?{write_link(run)}")

    def _write_verdict(self, segment: Segment | None) -> str:
        pace = "no top yet"
        if segment is not None:
            pace = f"{segment.factor:.3g} of real time" if segment.running else "paused"
        message = self._actions.message
        return (
            f'<div class="panel-box"><span class="panel-dim">{pace}</span>'
            f'<div class="panel-verdict">{escape(self._run.verdict)}</div>'
            + (f'<div class="panel-message">{escape(message)}</div></div>' if message else "</div>")
        )

    def follow(self, event: Event) -> None:
        """Show the values with which a motion began, also one that another program started."""
        segment = event.segment()
        motion, state = segment.motion, event.state()
        friction = (motion.friction.axial, motion.friction.transverse)
        values = dict(zip(TOP_PARAMETERS, (*motion.top.moments, *friction), strict=True))
        for name, field in self._numbers.items():
            _set(field, values[name])
        _set(self._speed, _clip(SLOWEST, math.log10(segment.factor), FASTEST))
        self._speed.label = _name_speed(segment.factor)
        if event.name in ("start", "reset") and not state.is_vertical:
            rates = state.euler_rates
            if event.values.get("request") == self._sent:
                return  # the sliders have moved it, and may have moved on
            _set(self._theta, _clip(self._theta.min, float(state.euler_angles.theta), math.pi))
            span = max(SPIN, math.ceil(1.2 * abs(float(rates.psi))))
            self._psi_dot.min, self._psi_dot.max = -span, span
            _set(self._psi_dot, round(float(rates.psi), 3))
            self._mark_rates(float(rates.phi))

    def _list_history(self) -> list[Event]:
        return list(self._run.history)[: -LISTED - 1 : -1]

    # What a user can do

    def _add_acts(self) -> None:
        gui, actions = self._gui, self._actions
        hurry = gui.add_button("Hurry the precession", color=BRAND, icon=Icon.ROTATE_2)
        hurry.on_click(lambda _: self._act("Hurry"))
        self._factor = gui.add_slider("factor of phi'", 1.05, 3.0, 0.05, FACTOR)
        self._others = gui.add_button_group("", ("Delay", "Pause", "Step", "Reset"))
        self._others.on_click(lambda event: self._act(event.target.value))
        self._speed = gui.add_slider(_name_speed(0.1), SLOWEST, FASTEST, 0.05, -1.0, marks=SPEEDS)
        self._on_move(self._speed, "speed", lambda: actions.set_speed(10 ** _within(self._speed)))

    def _add_pushes(self) -> None:
        self._gui.add_markdown(PUSHES)
        for label, sign in (("Torque about the vertical", 1.0), ("Torque backwards", -1.0)):
            button = self._gui.add_button(f"{label}: hold", color=SLATE)
            button.on_hold(partial(self._hold_torque, sign), callback_hz=20.0)

    def _hold_torque(self, sign: float, _: GuiEvent[GuiButtonHandle]) -> None:
        self._actions.hold_torque(sign)

    def _act(self, name: str) -> None:
        acts: dict[str, Act] = {
            "Hurry": lambda: self._actions.hurry(_within(self._factor)),
            "Delay": lambda: self._actions.hurry(1 / _within(self._factor)),
            "Step": self._actions.step,
            "Reset": lambda: self._actions.request("reset"),
        }
        acts.get(name, self._actions.toggle_pause)()

    def _add_start(self) -> None:
        gui, actions = self._gui, self._actions
        scenes = gui.add_dropdown("scene", ("choose ...", *scene_names()))
        scenes.on_update(self._from_user(lambda: actions.choose_scene(scenes.value)))
        self._theta = gui.add_slider("tilt (rad)", 0.0, 3.14, 0.01, 0.5)
        self._psi_dot = gui.add_slider("spin psi' (rad/s)", -SPIN, SPIN, 1.0, 200.0)
        self._rate_folder = gui.add_folder(None)
        self._phi_dot = self._add_rate((), 0.0)
        for slider in (self._theta, self._psi_dot):
            self._on_move(slider, "start", self._start)
        roots = gui.add_button_group("start on", ("slow root", "fast root"))
        roots.on_click(lambda event: self._start_on(event.target.value.split()[0]))
        self._numbers = {name: self._add_number(name) for name in NUMBERS}

    def _add_number(self, name: str) -> GuiNumberHandle[float]:
        label, step = NUMBERS[name]
        field = self._gui.add_number(label, 0.0, step=step)
        self._on_move(field, name, lambda: self._set_parameter(name, field.value))
        return field

    def _set_parameter(self, name: str, value: float) -> None:
        """Set a parameter of the top; the fields show what holds if it is refused."""
        if not self._actions.set_parameters({name: value}) and self._run.event is not None:
            self.follow(self._run.event)

    def _add_rate(self, rates: tuple[float, ...], value: float) -> GuiSliderHandle[float]:
        """Add the slider of phi' with the regular rates marked."""
        span = math.ceil(max([LEAST_RATE, 1.2 * abs(value), *(1.15 * abs(rate) for rate in rates)]))
        names = ("slow", "fast") if len(rates) == 2 else ("regular",)
        marks = tuple(zip(rates, names, strict=False))
        with self._rate_folder:
            slider = self._gui.add_slider(
                "precession phi' (rad/s)",
                float(-span),
                float(span),
                0.1,
                value,
                marks=marks or None,
            )
        self._on_move(slider, "start", self._start)
        return slider

    def _mark_rates(self, value: float) -> None:
        """Replace the slider of phi' if its marks or its range are no more those of the motion."""
        motion = self._run.motion
        if motion is None:
            return
        rates = regular_precession_rates(
            motion.top, theta=self._theta.value, psi_dot=self._psi_dot.value
        )
        # In the digits that are visible: else each rounding of theta would make a new slider.
        shown = tuple(float(f"{rate:.4g}") for rate in rates if abs(rate) < 1e4)
        if (shown, abs(value) <= self._phi_dot.max) != (self._marked, True):
            self._phi_dot.remove()
            self._marked = shown
            self._phi_dot = self._add_rate(shown, value)
        _set(self._phi_dot, round(value, 3))

    def _start(self) -> None:
        values = {
            "theta": self._theta.value,
            "phi_dot": self._phi_dot.value,
            "psi_dot": self._psi_dot.value,
        }
        self._sent = "; ".join(f"{name}={value!r}" for name, value in values.items())
        self._actions.start(values)
        self._mark_rates(values["phi_dot"])

    def _start_on(self, root: str) -> None:
        values = {"theta": self._theta.value, "psi_dot": self._psi_dot.value, "precession": root}
        self._actions.start(values)

    def _add_entry(self, k: int) -> GuiButtonHandle:
        entry = self._gui.add_button(
            f"entry {k}", visible=False, color=SLATE, hint="restart from this state"
        )

        @entry.on_click
        def _(_: GuiEvent[GuiButtonHandle]) -> None:
            listed = self._list_history()
            if k < len(listed):
                self._actions.restart_from(listed[k])

        return entry

    def _add_layers(self) -> None:
        for layer in LAYERS:
            self._gui.add_checkbox(layer, True).on_update(partial(self._show_layer, layer))
        theme = self._gui.add_button_group("this page", ("light", "dark"))
        theme.on_click(_set_theme)

    def _show_layer(self, layer: str, event: GuiEvent[GuiCheckboxHandle]) -> None:
        self._scene.shown[layer] = event.target.value

    def _add_saving(self) -> None:
        gui = self._gui
        gui.add_button("Picture (PNG)", icon=Icon.CAMERA, color=SLATE).on_click(_send_picture)
        self._record = gui.add_button("Record (MCAP)", icon=Icon.PLAYER_RECORD, color=SLATE)
        self._record.on_click(self._switch_recording)
        series = gui.add_button("Series (CSV)", icon=Icon.CHART_LINE, color=SLATE)
        series.on_click(self._send_series)
        self._link = gui.add_text("link", "", hint="append it to the address of this page")

    def _switch_recording(self, event: GuiEvent[GuiButtonHandle]) -> None:
        log = self._actions.switch_recording()
        if log is not None and event.client is not None:
            event.client.send_file_download(log.name, log.read_bytes(), save_immediately=True)

    def _send_series(self, event: GuiEvent[GuiButtonHandle]) -> None:
        if event.client is not None:
            content = self._run.csv().encode()
            event.client.send_file_download("series.csv", content, save_immediately=True)

    # Keys

    def _add_keys(self) -> None:
        actions = self._actions
        keys: dict[str, tuple[str, Act]] = {
            **{name: (name[0], partial(self._act, name)) for name in ("Hurry", "Delay", "Reset")},
            "Pause or resume": ("space", actions.toggle_pause),
            "Push the axle up": ("arrowup", lambda: actions.push_tilt(-KEY_PUSH)),
            "Push the axle down": ("arrowdown", lambda: actions.push_tilt(KEY_PUSH)),
            "Push the axle forward": ("arrowright", lambda: actions.push_along(KEY_PUSH)),
            "Push the axle back": ("arrowleft", lambda: actions.push_along(-KEY_PUSH)),
        }
        for label, (key, act) in keys.items():
            command: Any = self._gui.add_command(label, hotkey=key)  # type: ignore[arg-type]
            command.on_trigger(lambda _, act=act: act())

    # Callbacks

    def _from_user(self, act: Act) -> Callable[[GuiEvent[Any]], None]:
        """Return a callback for values that a user has changed, not the program."""

        def callback(event: GuiEvent[Any]) -> None:
            if event.client is not None:
                act()

        return callback

    def _on_move(self, handle: Any, kind: str, act: Act) -> None:
        handle.on_update(self._from_user(lambda: self._actions.last_of(kind, act, time.sleep)))


def _configure(target: ViserServer | ClientHandle, dark: bool) -> None:
    target.gui.configure_theme(
        show_logo=False, show_share_button=False, brand_color=BRAND, dark_mode=dark
    )


def _set_theme(event: GuiEvent[GuiButtonGroupHandle]) -> None:
    """Make the page of the user who has asked for it light or dark."""
    if event.client is not None:
        _configure(event.client, dark=event.target.value == "dark")


def _send_picture(event: GuiEvent[GuiButtonHandle]) -> None:
    """Send the page's picture of the scene, in the size that it has there."""
    client = event.client
    if client is None:
        return
    camera = client.camera
    image = client.get_render(
        camera.image_height, camera.image_width, transport_format="png", timeout=20.0
    )
    content = iio.imwrite("<bytes>", image, extension=".png")
    client.send_file_download("top.png", content, save_immediately=True)


def _set(handle: Any, value: float | str) -> None:
    """Set the value of a control. Callbacks see no client then, and send no request."""
    handle.value = value


def _describe(event: Event) -> str:
    asked = NUMBER.sub(lambda number: f"{float(number[0]):.3g}", event.values.get("request", ""))
    words = f"{event.name}: {asked}" if asked else event.name
    return words if len(words) <= 44 else f"{words[:41]}..."


def _name_speed(factor: float) -> str:
    return f"speed: {factor:.3g} of real time"


def _within(slider: GuiSliderHandle[float]) -> float:
    """Return the value of a slider. Viser's page keeps it in its range, but need not."""
    return _clip(slider.min, slider.value, slider.max)


def _clip(low: float, value: float, high: float) -> float:
    return min(max(value, low), high)
