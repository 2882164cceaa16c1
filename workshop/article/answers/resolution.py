"""The resolution principle: free motion with impulses of the torque, step by step.

The article says that it "can not be used to study the general motion". It is a splitting of the
equations of motion, and converges to every motion.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, columns, new_figure
from symtop_ros.physics import Motion, State, Top, apply_impulse
from workshop.article.claims import Measured, claim
from workshop.article.motions import cusps

SPAN = 0.5  # s; three nutations
COUNTS = (100, 200, 400, 800, 1600)  # steps in this time
SHOWN = 12  # steps of the chain that is drawn
STORY = 0.48  # s, in which they are made: three nutations
ORDER = 0.02  # of an order that is found from two steps. Measured: 0.001 and 0.0001


def resolve(motion: Motion, span: float, count: int, symmetric: bool = False) -> list[State]:
    """Return the states after each of `count` steps: an impulse of the torque, then free motion.

    In a symmetric step half of the impulse comes before the free motion, and half after it.
    """
    top = motion.top
    states = [motion.start]
    free = Top(top.Ix, top.Iz, 0.0)
    step = span / count
    for _ in range(count):
        state = _push(top, states[-1], step / 2 if symmetric else step)
        state = Motion(free, state).at(step)
        states.append(_push(top, state, step / 2) if symmetric else state)
    return states


def _push(top: Top, state: State, time: float) -> State:
    return apply_impulse(top, state, time * top.gravity_torque(state))


def find_errors(motion: Motion, symmetric: bool) -> list[float]:
    """Return the angle in rad between the axis and that of the closed form, for each count."""
    z = np.array([0.0, 0.0, 1.0])
    exact = motion.at(SPAN).to_world(z)
    ends = [resolve(motion, SPAN, count, symmetric)[-1].to_world(z) for count in COUNTS]
    return [float(np.linalg.norm(np.cross(end, exact))) for end in ends]


@claim()
def resolution_converges(top: Top) -> Measured:
    """Check that the steps of the resolution principle converge to the motion, and how fast."""
    motion = cusps(top)
    first, second = find_errors(motion, symmetric=False), find_errors(motion, symmetric=True)
    orders = [float(np.log2(each[-2] / each[-1])) for each in (first, second)]
    errors = first[-1], second[-1]
    holds = (
        abs(orders[0] - 1) < ORDER
        and abs(orders[1] - 2) < ORDER
        and f"{errors[1]:.1e}" == "2.4e-06"
    )
    return Measured(holds, errors=errors, step=1e3 * SPAN / COUNTS[-1], orders=orders)


def draw_resolution(motion: Motion | None = None) -> Figure:
    """Draw the end of L for steps head to tail, and the error against the step."""
    motion = motion or cusps()
    figure = new_figure(3.6)
    left, right = columns(figure, 2)
    _draw_steps(left, motion)
    steps = 1e3 * SPAN / np.array(COUNTS)
    for symmetric, color, mark, label in (
        (False, BLUE, "o-", "impulse, then free"),
        (True, RED, "s--", "half, free, half"),
    ):
        right.loglog(steps, find_errors(motion, symmetric), mark, color=color, ms=5, label=label)
    right.set(xlabel="step (ms)", ylabel=f"error of the axis after {SPAN:g} s (rad)")
    right.set_xticks(steps, [f"{step:.2g}" for step in steps])
    right.minorticks_off()
    right.legend(loc="lower right")
    right.set_title("orders 1 and 2")
    return figure


def _draw_steps(axes: Axes, motion: Motion) -> None:
    """Draw the horizontal L of the exact motion, and the impulses of the steps head to tail."""
    times = np.linspace(0.0, STORY, 801)
    exact = _horizontal(motion, motion.at(times))
    states = resolve(motion, STORY, SHOWN)
    ends = np.array([_horizontal(motion, state) for state in states])
    axes.plot(*exact.T, color=GREY, lw=1.7, label="exact")
    look: Any = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.016, "zorder": 3}
    label = rf"$\tau\,dt$, {SHOWN} steps"
    axes.quiver(*ends[:-1].T, *np.diff(ends, axis=0).T, color=GOLD, label=label, **look)
    axes.plot(*ends[0], "o", color=INK, ms=5, label="start")
    axes.set(aspect="equal", xlabel="$L_{x'}$ ($10^{-3}$ N m s)")
    axes.set_ylabel("$L_{y'}$ ($10^{-3}$ N m s)")
    axes.set_title(f"three nutations, steps of {1e3 * STORY / SHOWN:.0f} ms")
    axes.set(xlim=(-4.5, 7.5), ylim=(-7, 7.5))
    axes.legend(loc="center left", handlelength=1.5)


def _horizontal(motion: Motion, states: State) -> Real:
    return np.asarray(1e3 * motion.top.angular_momentum(states)[..., :2])
