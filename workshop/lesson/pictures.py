"""The pictures of the lesson: what each step shows, computed from the acts of the step.

A start begins a run; a hurry or pushes kick the last run. Regular precession is the only motion
that is kicked, so that the time of the kick is free.
"""

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, new_figure
from symtop_ros.page.web.join import read_record
from symtop_ros.physics import (
    Motion,
    State,
    Top,
    hurry,
    push_axle,
    regular_precession_rates,
    theta_acceleration,
)
from symtop_ros.replay.view.entities import draw_parallel
from symtop_ros.replay.view.torques import torques_of
from symtop_ros.run.simulation.changes.requests import initial_state
from symtop_ros.run.simulation.settings import Settings
from workshop.article.answers.fictitious import draw_arrow, plot_torques
from workshop.article.answers.impulses import plot_impulses
from workshop.article.answers.ledger import KickLedger, plot_ledger
from workshop.article.figures import plot_depth
from workshop.article.motions import PSI_DOT, THETA, TOP, KickedMotion
from workshop.lesson.steps import LessonAct, LessonStep, read_lesson
from workshop.pictures.pack import pack_figure

KICK = 0.4  # s
TRACE, TURNS = 1.0, 2.0  # s, and turns of the precession: whichever is shorter is drawn
SHORT = 0.08  # s in which the fast precession makes most of a turn
SPAN = 0.8  # s of the plots
LOOKS = ((BLUE, "-"), (RED, "--"), (GOLD, "-."), (INK, ":"))
NOT_KICKED = "not kicked"
HELD = {"spin_rate": r"$\dot\psi$", "spin_momentum": r"$p_\psi$"}
CHAIN = (GREY, BLUE, RED, INK)  # colours as over phi'
SHORTEST = 0.01  # of the largest torque
Runs = dict[str, KickedMotion]


def run_step(step: LessonStep) -> Runs:
    """Return the runs of a step by their labels."""
    settings = Settings.from_scene(step.scene)
    runs = Runs()
    for act in step.acts:
        if act.record:
            motion = read_motion(act.record)
            spin = float(motion.start.angular_velocity[2])
            runs[rf"$\omega_z$ = {spin:.4g} rad/s"] = KickedMotion.of(motion)
        elif act.start is None:
            _, run = runs.popitem()
            runs.pop(NOT_KICKED, None)
            rate = run.pieces[0][1].start.euler_rates.phi_dot
            runs[f"from {rate:.3g} rad/s, {_name_held(act)} held"] = _kick(run, act)
            runs[NOT_KICKED] = run
        else:
            start = initial_state(settings.top, settings.initial, act.start or {})
            runs[_name_start(start)] = KickedMotion.of(Motion(settings.top, start))
    return runs


def read_motion(spin: float) -> Motion:
    """Return the motion of the record's run, of a top with so many times its spin."""
    (event,) = read_record(spin)["events"]
    return Motion(Top(*event["top"]), State(event["orientation"], event["angular_velocity"]))


def _draw_record_from_above(axes: Axes, runs: Runs) -> None:
    """Draw the paths of the axis through the points of the record."""
    _draw_from_above(axes, runs)
    points = read_record(1)["points"]
    x, y, _ = np.array(points["values"])[np.array(points["times"]) <= TRACE].T
    axes.plot(x, y, ".", color=INK, markersize=2.5, zorder=3)


def draw_record(axes: Axes, runs: Runs) -> None:
    """Draw theta against time, with the points of the record."""
    draw_tilt(axes, runs)
    points = read_record(1)["points"]
    x, y, z = np.array(points["values"]).T
    times = np.array(points["times"])
    shown = times <= SPAN
    axes.plot(times[shown], np.arctan2(np.hypot(x, y), z)[shown], ".", color=INK, markersize=3.5)


def _name_start(start: State) -> str:
    rates = start.euler_rates
    tilting = rf"$\dot\theta$ = {rates.theta_dot:.3g}, " if rates.theta_dot else ""
    return rf"{tilting}$\dot\phi$ = {rates.phi_dot:.3g}, $\dot\psi$ = {rates.psi_dot:.4g} rad/s"


def _name_held(act: LessonAct) -> str:
    return r"$\phi$" if act.clamp else HELD["spin_momentum" if act.push else act.hold]


def _kick(run: KickedMotion, act: LessonAct) -> KickedMotion:
    """Return a run with the hurry, the pushes or the clamp of a button."""
    if act.clamp:
        return run.clamp(KICK)
    if not act.push:
        return run.kick(KICK, partial(hurry, factor=act.hurry or 1.0, hold=act.hold))
    top = run.pieces[0][1].top
    impulse = act.push["axle_impulse"]
    for place in range(int(act.push["number"])):
        time = KICK + place / act.push["rate"]
        run = run.kick(time, lambda state: push_axle(top, state, impulse))
    return run


def draw_step(step: LessonStep) -> Figure:
    """Draw a step: the end of the axis from above, and the quantity that the step explains."""
    figure = new_figure(2.9)
    left, right = figure.subplots(1, 2, width_ratios=[2, 3])
    runs = run_step(step)
    for axes, draw in zip((left, right), DRAWS[step.plot], strict=True):
        draw(axes, runs)
    right.margins(x=0)
    return figure


def _list_first(runs: Runs) -> list[Motion]:
    """Return the motions with which the runs begin."""
    return [run.pieces[0][1] for run in runs.values()]


def _draw_turned(axes: Axes, runs: Runs) -> None:
    """Draw how far the axis turns in a short time, with L and the torque that turns it."""
    (motion,) = _list_first(runs)
    ends = motion.at(np.linspace(0.0, SHORT, 401)).to_world([0.0, 0.0, 1.0])
    axes.plot(*draw_parallel(THETA, 181)[:, :2].T, color=GREY, lw=0.7)
    axes.plot(ends[:, 0], ends[:, 1], color=BLUE, lw=2.4)
    axes.plot(*ends[0, :2], "o", color=BLUE)
    L = motion.top.angular_momentum(motion.start)
    axes.plot(0, 0, "+", color=INK)
    # both start at the centre; each has its own scale, the same in both pictures
    for vector, size, color, name in (
        (L, 80.0, INK, "L"),
        (motion.top.gravity_torque(motion.start), 8.0, RED, "torque"),
    ):
        x, y = size * vector[:2]
        draw_arrow(axes, (0, 0), (x, y), color)
        axes.annotate(name, (x, y), (4, 4), textcoords="offset points", color=color)
    axes.set(aspect="equal", title=f"from above, {SHORT} s")
    axes.set_axis_off()


def _draw_chains(axes: Axes, runs: Runs) -> None:
    """Draw the torques of an observer who precesses, head to tail, and their sum below."""
    for row, motion in enumerate(_list_first(runs)):
        torques = torques_of(motion.top, motion.start)
        largest = max(abs(float(torque)) for torque in torques)
        ends = np.cumsum([0.0, *torques]) / largest
        arrows = [*pairwise(ends), (0.0, ends[-1])]
        for k, ((tail, tip), color) in enumerate(zip(arrows, CHAIN, strict=True)):
            y = -row - 0.14 * k
            if abs(tip - tail) > SHORTEST:
                draw_arrow(axes, (tail, y), (tip, y), color)
        rate = float(motion.start.euler_rates.phi_dot)
        axes.text(-1.05, -row - 0.2, f"{rate:.3g} rad/s", ha="right", va="center", fontsize=8)
    axes.axvline(0.0, color=GREY, lw=0.7, ls=":")
    axes.set(xlim=(-1.9, 1.15), ylim=(-len(runs) + 0.3, 0.25))
    axes.set_title("at the start, rows not to one scale", fontsize=8)
    axes.set_axis_off()


def draw_fictitious(axes: Axes, runs: Runs) -> None:
    """Draw the torques over phi', with the rates of the runs."""
    plot_torques(axes)
    for motion in _list_first(runs):
        total = float(torques_of(motion.top, motion.start).total)
        axes.plot(float(motion.start.euler_rates.phi_dot), total, "o", color=INK, ms=5, zorder=3)
    axes.set_ylabel("torque (N m)")
    axes.legend(loc="upper left", fontsize=8)


def _draw_from_above(axes: Axes, runs: Runs) -> None:
    for (color, dash), run in zip(LOOKS, runs.values(), strict=False):
        begin, motion = run.pieces[-1]
        for angle in motion.turning_angles:
            axes.plot(*draw_parallel(angle, 181)[:, :2].T, color=GREY, lw=0.7, ls=":")
        times = np.linspace(begin, begin + min(TRACE, TURNS * motion.precession_period), 3001)
        ends = run.at(times).to_world([0.0, 0.0, 1.0])
        axes.plot(ends[:, 0], ends[:, 1], color=color, ls=dash, lw=1.4)
    axes.plot(0, 0, "+", color=INK)
    axes.set(aspect="equal", title="end of the axis, from above")
    axes.set_axis_off()


def draw_tilt(axes: Axes, runs: Runs) -> None:
    """Draw theta against time."""
    times = _list_times(runs)
    for (color, dash), (label, run) in zip(LOOKS, runs.items(), strict=False):
        axes.plot(times, run.at(times).euler_angles.theta, color=color, ls=dash, label=label)
    if NOT_KICKED in runs:
        axes.axvline(KICK, color=GREY, lw=0.9, ls=":")
    low, high = axes.get_ylim()
    room = max(high - low, 0.003)  # regular precession is a line, not rounding
    axes.set(xlabel="$t$ (s)", ylabel=r"$\theta$ (rad)")
    lines = max(3, len(runs))  # of the legend, above the curves
    axes.set_ylim(low - 0.05 * room, low + (1 + 0.15 * lines) * room)
    hangs = any(motion.top.Mgl < 0 for motion in _list_first(runs))
    words = "higher axis, lower body" if hangs else "higher"
    axes.set_title(rf"smaller $\theta$: {words}", loc="right")
    axes.legend(loc="upper left", fontsize=8)


def _list_times(runs: Runs) -> Real:
    """Return times in s until some time after the last kick."""
    last = max(run.pieces[-1][0] for run in runs.values())
    return np.linspace(0.0, max(SPAN, last + KICK), 1601)


def draw_pushes(axes: Axes, runs: Runs) -> None:
    """Draw how much phi' has changed against time."""
    times = _list_times(runs)
    for (color, dash), (label, run) in zip(LOOKS, runs.items(), strict=False):
        rates = run.at(times).euler_rates.phi_dot
        axes.plot(times, rates - rates[0], color=color, ls=dash, label=label)
    axes.set(xlabel="$t$ (s)", ylabel=r"change of $\dot\phi$ (rad/s)")
    axes.set_title("faster: up", loc="right")


def draw_momentum(axes: Axes, runs: Runs) -> None:
    """Draw the components of L in the world frame, and the one along the axis."""
    times = np.linspace(0.0, SPAN, 1601)
    (run,) = runs.values()
    top = run.pieces[0][1].top
    states = run.at(times)
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


def draw_potential(axes: Axes, runs: Runs) -> None:
    """Draw the effective potentials, from which the turning angles can be read."""
    looks = zip(LOOKS, runs, _list_first(runs), strict=False)
    for (color, dash), label, motion in looks:
        plot_depth(axes, motion, np.linspace(0.35, 1.25, 600), color=color, ls=dash, label=label)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.set(ylim=(-6.0, 11.0))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))


def draw_parabola(axes: Axes, runs: Runs) -> None:
    """Draw theta'' against phi', with the roots of regular precession and the run's place."""
    rates = np.linspace(-10.0, 88.0, 400)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.plot(rates, theta_acceleration(TOP, THETA, rates, PSI_DOT), color=INK)
    roots = regular_precession_rates(TOP, THETA, PSI_DOT)
    axes.plot(roots, [0, 0], "o", color="white", mec=INK, ms=7)
    for (color, _), motion in zip(LOOKS, _list_first(runs), strict=False):
        axes.plot(motion.start.euler_rates.phi_dot, 0, "o", color=color, ms=7, zorder=3)
    for x, y, word, side in (
        (38, -260, "the top rises", "center"),
        (80, 330, "falls", "right"),
        (-4, 300, "falls", "left"),
    ):
        axes.text(x, y, word, ha=side, style="italic")
    axes.set(xlabel=r"$\dot\phi$ (rad/s)", ylabel=r"$\ddot\theta$ (rad/s$^2$)")


def draw_turning(axes: Axes, runs: Runs) -> None:
    """Draw L and the axis in their vertical plane, which the torque turns; theta'' in an inset."""
    (motion,) = _list_first(runs)
    L = 1e3 * motion.top.angular_momentum(motion.start)
    flat = float(np.hypot(L[0], L[1]))
    rate = float(motion.start.euler_rates.phi_dot)
    torque = 1e3 * float(np.linalg.norm(motion.top.gravity_torque(motion.start)))
    reach = 20.0 * np.array([np.sin(THETA), np.cos(THETA)])
    axes.plot(*zip((0, 0), reach, strict=True), color=BLUE, ls="--", label="axis")
    draw_arrow(axes, (0, 0), (flat, L[2]), INK, 2.2)
    axes.plot([flat, flat], [0, L[2]], color=GREY, lw=0.9, ls=":")
    axes.plot([0, flat], [0.15, 0.15], color=RED, lw=3, label="horizontal part of $L$")
    text = f"torque / horizontal part of $L$\n= {torque:.3g} / {flat:.3g} = {rate:.3g} rad/s"
    axes.set_title(text, fontsize=9)
    axes.text(flat + 0.3, L[2], "$L$")
    axes.set(xlim=(-0.5, 20), ylim=(0, 20), xlabel="horizontal ($10^{-3}$ N m s)")
    axes.set_ylabel("vertical")
    axes.legend(loc="lower right", fontsize=8)
    inset = axes.inset_axes((0.58, 0.45, 0.42, 0.47))
    draw_parabola(inset, runs)
    inset.tick_params(labelsize=7)
    inset.set(xlabel="", ylabel="")
    inset.set_title(r"$\ddot\theta$ over $\dot\phi$", fontsize=8)
    for text_in_inset in inset.texts:
        text_in_inset.set_visible(False)


def draw_ledger(axes: Axes, runs: Runs) -> None:
    """Draw the changes of energy by the first kick, with the energy that it puts into the spin."""
    first = next(iter(runs.values()))
    (_, before), (_, after) = first.pieces
    ledger = KickLedger.of(after.top, before.start, after.start)
    plot_ledger(axes, ledger)
    axes.set_ylabel("change (mJ)")
    axes.set_title(rf"$\dot\psi$ held; into the spin: {ledger.kick.spin:+.1f} mJ", fontsize=9)
    axes.legend(loc="lower left", fontsize=8)


def draw_impulses(axes: Axes, runs: Runs) -> None:
    """Draw the torques of one fall, and their impulses."""
    plot_impulses(axes, *_list_first(runs))
    axes.set_xlabel("$t$ (ms)")
    title = r"torque, and its impulse in $10^{-3}$ N m s"
    axes.legend(loc="lower left", bbox_to_anchor=(-0.2, 1.0), ncols=2, fontsize=8, title=title)


Draw = Callable[[Axes, Runs], None]
DRAWS: dict[str, tuple[Draw, Draw]] = {  # left and right, by the field `plot` of a step
    "tilt": (_draw_from_above, draw_tilt),
    "momentum": (_draw_from_above, draw_momentum),
    "potential": (_draw_from_above, draw_potential),
    "turning": (_draw_turned, draw_turning),
    "fictitious": (_draw_chains, draw_fictitious),
    "ledger": (draw_tilt, draw_ledger),
    "impulses": (_draw_from_above, draw_impulses),
    "pushes": (draw_tilt, draw_pushes),
    "record": (_draw_record_from_above, draw_record),
}


def write_lesson(folder: Path) -> None:
    """Write the pictures step_01.png, step_02.png ..."""
    steps = read_lesson()
    for number, step in enumerate(steps, start=1):
        (folder / f"step_{number:02}.png").write_bytes(picture_of(step))
    print(f"wrote {len(steps)} pictures to {folder}")


def picture_of(step: LessonStep) -> bytes:
    """Return the picture of a step as a PNG."""
    return pack_figure(lambda: draw_step(step))
