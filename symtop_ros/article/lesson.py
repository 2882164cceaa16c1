"""The pictures of docs/lesson.md: what each step shows, computed from the commands of the step.

The commands are those of `top_ctl` that a class types. A start begins a run; a hurry kicks the last
run. Regular precession is the only motion that is hurried, so that the time of the kick is free.
"""

import io
import shlex
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from symtop_ros.article.figures import DEPTH
from symtop_ros.article.motions import (
    HANGING_DISC,
    PSI_DOT,
    THETA,
    TOP,
    KickedMotion,
    precession_period,
)
from symtop_ros.article.rates import FACTOR
from symtop_ros.drawing.style import BLUE, GREY, INK, RED, SETTINGS, new_figure
from symtop_ros.physics import (
    EffectivePotential,
    Motion,
    hurry,
    regular_precession_rates,
    theta_acceleration,
)
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.settings import InitialConditions

KICK = 0.4  # s
TRACE, TURNS = 1.0, 2.0  # s, and turns of the precession: whichever is shorter is drawn
SPAN = 0.8  # s of the plots
RESOLUTION, COLORS = 130, 64  # dots per inch, colours of a palette
LOOKS = ((BLUE, "-"), (RED, "--"))
SCENES = {  # tops and initial conditions of the nodes
    "/top": (TOP, InitialConditions(theta=0.5, psi_dot=200.0)),
    "/disc": (
        HANGING_DISC,
        InitialConditions(theta=0.5, psi_dot=-25.0, precession="slow"),
    ),
}
Draw = Callable[[Axes, dict[str, KickedMotion]], None]


@dataclass(frozen=True, slots=True)
class LessonStep:
    """One step of the lesson."""

    title: str  # as in the headline of the step
    commands: tuple[str, ...]  # as one types them
    draw: Draw  # draws the right half of the picture

    def runs(self) -> dict[str, KickedMotion]:
        """Return the runs of the step by their labels."""
        runs: dict[str, KickedMotion] = {}
        for command in self.commands:
            _follow(shlex.split(command), runs)
        return runs


def _follow(words: list[str], runs: dict[str, KickedMotion]) -> None:
    """Apply a command: begin a run, or hurry the last one."""
    name = words[words.index("--node") + 1] if "--node" in words else "/top"
    top, defaults = SCENES[name]
    if "hurry" in words:
        label, run = runs.popitem()
        runs["hurried"] = run.kick(KICK, lambda state: hurry(state, FACTOR))
        runs["not kicked"] = run
    elif "start" in words or "reset" in words:
        fields = dict(word.split("=") for word in words if "=" in word)
        request = {
            key: text if key == "precession" else float(text) for key, text in fields.items()
        }
        motion = Motion(top, initial_state(top, defaults, request))
        rates = motion.start.euler_rates
        label = f"$\\dot\\phi$ = {rates.phi:.3g}, $\\dot\\psi$ = {rates.psi:.4g} rad/s"
        runs[label] = KickedMotion.of(motion)


def draw_step(step: LessonStep) -> Figure:
    """Draw a step: the end of the axis from above, and the quantity that the step explains."""
    figure = new_figure(2.9)
    left, right = figure.subplots(1, 2, width_ratios=[2, 3])
    runs = step.runs()
    _draw_from_above(left, runs)
    step.draw(right, runs)
    right.margins(x=0)
    return figure


def _draw_from_above(axes: Axes, runs: dict[str, KickedMotion]) -> None:
    around = np.linspace(0.0, 2 * np.pi, 181)
    for (color, dash), run in zip(LOOKS, runs.values(), strict=False):
        begin, motion = run.pieces[-1]
        for angle in motion.turning_angles:
            rim = np.sin(angle)
            axes.plot(rim * np.cos(around), rim * np.sin(around), color=GREY, lw=0.7, ls=":")
        times = np.linspace(begin, begin + min(TRACE, TURNS * precession_period(motion)), 3001)
        ends = run.at(times).to_world([0.0, 0.0, 1.0])
        axes.plot(ends[:, 0], ends[:, 1], color=color, ls=dash, lw=1.4)
    axes.plot(0, 0, "+", color=INK)
    axes.set(aspect="equal", title="end of the axis, from above")
    axes.set_axis_off()


def draw_tilt(axes: Axes, runs: dict[str, KickedMotion]) -> None:
    """Draw theta against time."""
    times = np.linspace(0.0, SPAN, 1601)
    for (color, dash), (label, run) in zip(LOOKS, runs.items(), strict=False):
        axes.plot(times, run.at(times).euler_angles.theta, color=color, ls=dash, label=label)
    if "hurried" in runs:
        axes.axvline(KICK, color=GREY, lw=0.9, ls=":")
    low, high = axes.get_ylim()
    room = max(high - low, 0.003)  # regular precession is a line, not rounding
    axes.set(xlabel="$t$ (s)", ylabel=r"$\theta$ (rad)")
    axes.set_ylim(low - 0.05 * room, low + 1.45 * room)
    axes.set_title(r"smaller $\theta$: higher", loc="right")
    axes.legend(loc="upper left")


def draw_momentum(axes: Axes, runs: dict[str, KickedMotion]) -> None:
    """Draw the components of L in the world frame, and the one along the axis."""
    times = np.linspace(0.0, SPAN, 1601)
    (run,) = runs.values()
    top, states = run.pieces[0][1].top, run.at(times)
    L = 1e3 * top.angular_momentum(states)
    curves = {
        "$L_{x'}$": (L[:, 0], RED, "--"),
        "$L_{y'}$": (L[:, 1], BLUE, "--"),
        "$L_{z'}$": (L[:, 2], INK, "-"),
        "$L_z$": (1e3 * top.axial_momentum(states), BLUE, "-"),
    }
    for label, (values, color, dash) in curves.items():
        axes.plot(times, values, color=color, ls=dash, label=label)
    axes.set(xlabel="$t$ (s)", ylabel="$L$ ($10^{-3}$ N m s)", ylim=(-8.5, 17.5))
    axes.legend(loc="upper center", ncols=4, columnspacing=1.0, handlelength=1.6)


def draw_potential(axes: Axes, runs: dict[str, KickedMotion]) -> None:
    """Draw the effective potentials, from which the turning angles can be read."""
    for (color, dash), (label, run) in zip(LOOKS, runs.items(), strict=False):
        motion = run.pieces[0][1]
        potential = EffectivePotential.of(motion.top, motion.start)
        theta = np.linspace(0.35, 1.25, 600)
        depth = 1e3 * (potential.at(theta) - potential.energy)
        axes.plot(theta, depth, color=color, ls=dash, label=label)
        axes.plot(motion.turning_angles, [0, 0], "o", color=color, ms=5)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.set(xlabel=r"$\theta$ (rad)", ylabel=DEPTH, ylim=(-6.0, 11.0))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))


def draw_parabola(axes: Axes, runs: dict[str, KickedMotion]) -> None:
    """Draw theta'' against phi', with the roots of regular precession and the run's place."""
    rates = np.linspace(-10.0, 88.0, 400)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.plot(rates, theta_acceleration(TOP, THETA, rates, PSI_DOT), color=INK)
    roots = regular_precession_rates(TOP, THETA, PSI_DOT)
    axes.plot(roots, [0, 0], "o", color="white", mec=INK, ms=7)
    for (color, _), run in zip(LOOKS, runs.values(), strict=False):
        axes.plot(run.pieces[0][1].start.euler_rates.phi, 0, "o", color=color, ms=7, zorder=3)
    for x, y, word, side in (
        (38, -260, "the top rises", "center"),
        (80, 330, "falls", "right"),
        (-4, 300, "falls", "left"),
    ):
        axes.text(x, y, word, ha=side, style="italic")
    axes.set(xlabel=r"$\dot\phi$ (rad/s)", ylabel=r"$\ddot\theta$ (rad/s$^2$)")


STEPS = (
    LessonStep("Let go at rest", ("top_ctl start theta=0.5 psi_dot=200",), draw_tilt),
    LessonStep(
        "Three numbers that stay",
        ("top_ctl start theta=0.5 psi_dot=200", "top_ctl state"),
        draw_momentum,
    ),
    LessonStep(
        "How deep does it fall?",
        (
            "top_ctl start theta=0.5 psi_dot=150",
            "top_ctl start theta=0.5 psi_dot=300",
        ),
        draw_potential,
    ),
    LessonStep(
        "A push that stops the nodding",
        ("top_ctl start theta=0.5 psi_dot=200 precession=slow",),
        draw_parabola,
    ),
    LessonStep(
        "One torque, two precessions",
        ("top_ctl start theta=0.5 psi_dot=200 precession=fast",),
        draw_parabola,
    ),
    LessonStep(
        "Two starts that begin alike",
        (
            "top_ctl start theta=0.5 psi_dot=200 phi_dot=0",
            "top_ctl start theta=0.5 psi_dot=200 phi_dot=76.322",
        ),
        draw_tilt,
    ),
    LessonStep(
        "Below the root and above it",
        (
            "top_ctl start theta=0.5 psi_dot=200 phi_dot=3",
            "top_ctl start theta=0.5 psi_dot=200 phi_dot=9",
        ),
        draw_tilt,
    ),
    LessonStep(
        "Hurry on the precession, and the body rises",
        ("top_ctl start theta=0.5 psi_dot=200 precession=slow", "top_ctl hurry"),
        draw_tilt,
    ),
    LessonStep(
        "The same hurry on the fast root",
        ("top_ctl start theta=0.5 psi_dot=200 precession=fast", "top_ctl hurry"),
        draw_tilt,
    ),
    LessonStep(
        "The axis falls, and the body rises",
        ("top_ctl --node /disc reset", "top_ctl --node /disc hurry"),
        draw_tilt,
    ),
)


def write_lesson(folder: Path) -> int:
    """Write the pictures step_01.png to step_10.png; return the exit status."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, step in enumerate(STEPS, start=1):
        save_step(step, folder / f"step_{number:02}.png")
    print(f"wrote {len(STEPS)} pictures to {folder}")
    return 0


def save_step(step: LessonStep, file: Path) -> None:
    """Draw a step into a PNG with a palette, which has a third of the size."""
    memory = io.BytesIO()
    with rc_context(SETTINGS):
        draw_step(step).savefig(memory, dpi=RESOLUTION)
    with Image.open(memory) as picture:
        picture.convert("RGB").quantize(COLORS).save(file, optimize=True)
