"""An axis that is let go at rest, without spin and with it, and torque alone: claims and figure."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, columns, new_figure
from symtop_ros.physics import Motion, State, Top, regular_precession_rates, theta_acceleration
from workshop.article.claims import Measured, claim
from workshop.article.motions import FAST, PSI_DOT, THETA, TOP, cusps, start

SPINS = (0.0, 20.0, 60.0, 100.0, 200.0, 400.0)  # rad/s
SAME_TILT = 1e-14  # rad; rounding of the arc cosine. Measured: 4e-16
SPAN = 0.5  # s; three nutations
INTEGRATED = 1e-12  # rad; relative tolerance 1e-13 over three nutations. Measured: 6e-14
KEPT = 1e-12  # relative; constants along the integrated motion. Measured: 2e-14
STEP, STEPS = 0.02, 7  # s, and the number of steps of L + torque dt
BESIDE = 0.8  # 10^-3 N m s between a chain that lies on L and L


def largest_tilt(top: Top, psi_dot: float) -> float:
    """Return the largest theta in rad after a release at rest, from the constants of motion."""
    ratio = (top.Iz * psi_dot) ** 2 / (4 * top.Ix * top.Mgl)
    return float(np.arccos(ratio - np.sqrt(ratio**2 - 2 * ratio * np.cos(THETA) + 1)))


@claim()
def spin_limits_the_fall(top: Top) -> Measured:
    """Check how far an axis falls that is let go at rest, for several spin rates."""
    motions = [Motion(top, start(0.0, spin)) for spin in SPINS]
    reached = [float(each.at(each.nutation_period / 2).euler_angles.theta) for each in motions]
    expected = [largest_tilt(top, spin) for spin in SPINS]
    off = float(np.abs(np.array(reached) - expected).max())
    words = ", ".join(
        f"{np.degrees(tilt):.1f} at {spin:g}" for tilt, spin in zip(reached, SPINS, strict=True)
    )
    holds = off < SAME_TILT and (np.diff(reached) < 0).all() and np.pi - reached[0] < SAME_TILT
    return Measured(holds, words=words, off=off)


@claim()
def spin_has_three_cases(top: Top) -> Measured:
    """Check when psi' falls, falls and rises, or rises while the axis falls from its cusp."""
    cases = ((THETA, PSI_DOT, "falls"), (THETA, 60.0, "falls, then rises"), (2.0, PSI_DOT, "rises"))
    words, agrees = [], []
    for theta, spin, case in cases:
        motion = Motion(top, State.from_euler(theta=theta, psi_dot=spin))
        states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
        slopes = np.sign(np.diff(states.euler_rates.psi_dot))
        turn = (1 - np.sin(theta)) / np.cos(theta)  # cos(theta) where psi' is least
        low = np.cos(states.euler_angles.theta)
        # the steps whose ends are both above the tilt, and both below it
        above = low[1:] > turn
        below = low[:-1] < turn
        found = "falls" if not below.any() else "falls, then rises" if above.any() else "rises"
        agrees.append(found == case and (slopes[above] < 0).all() and (slopes[below] > 0).all())
        words.append(f"theta_0 = {theta:g} rad, psi' = {spin:g} rad/s: {case}")
    return Measured(all(agrees), listed="; ".join(words))


@claim()
def regular_precession_needs_spin(top: Top) -> Measured:
    """Check the least spin rate with regular precession, and that below it every top falls."""
    least = 2 * np.sqrt((top.Ix - top.Iz) * top.Mgl * np.cos(THETA)) / top.Iz
    above, below = (
        int(np.isfinite(regular_precession_rates(top, THETA, float(factor * least))).sum())
        for factor in (1 + 1e-9, 1 - 1e-9)
    )
    rates = np.linspace(-FAST, 2 * FAST, 4001)
    slow, fast = (
        float(theta_acceleration(top, THETA, rates, factor * least).min())
        for factor in (0.99, 1.01)
    )
    holds = f"{least:.2f}" == "111.63" and (above, below) == (2, 0) and slow > 0 > fast
    return Measured(holds, least=least, above=above, below=below, slow=slow, fast=fast)


def integrate_torque(motion: Motion, times: Real) -> State:
    """Return the states (n,) of dL/dt = torque and dq/dt = q omega/2, by SciPy's DOP853."""
    top = motion.top
    moments = np.array([motion.top.Ix, motion.top.Ix, motion.top.Iz])

    def rates(_: float, y: Real) -> Real:
        turned = State(y[:4], np.zeros(3))
        q = y[:4]
        omega = turned.to_body(y[4:]) / moments
        turning = [-q[1:] @ omega, *(q[0] * omega + np.cross(q[1:], omega))]
        return np.array([*(0.5 * np.array(turning)), *top.gravity_torque(turned)])

    first = [*motion.start.orientation, *top.angular_momentum(motion.start)]
    span = (float(times[0]), float(times[-1]))
    found = solve_ivp(rates, span, first, "DOP853", times, rtol=1e-13, atol=1e-15)
    turned = State(found.y[:4].T, np.zeros((len(times), 3)))
    return State(turned.orientation, turned.to_body(found.y[4:].T) / moments)


@claim()
def torque_suffices(top: Top) -> Measured:
    """Check that torque = dL/dt alone, integrated, gives the motion and keeps the constants."""
    times = np.linspace(0.0, SPAN, 21)
    motion = cusps(top)
    found = integrate_torque(motion, times)
    exact = motion.at(times)
    axes = [np.asarray(states.to_world([0.0, 0.0, 1.0])) for states in (found, exact)]
    off = float(np.linalg.norm(axes[0] - axes[1], axis=1).max())
    momenta = top.angular_momentum(found)
    constants = top.energy(found), momenta[:, 2], (momenta * axes[0]).sum(axis=1)
    kept = max(float(np.ptp(each) / abs(each[0])) for each in constants)
    return Measured(off < INTEGRATED and kept < KEPT, motion=motion, off=off, kept=kept)


def draw_release() -> Figure:
    """Draw L + torque dt head to tail, without spin and with it, and theta for six spin rates."""
    figure = new_figure(6.6)
    parts: Any = figure.subfigures(2, 1)
    upper, lower = parts
    for axes, spin in zip(columns(upper, 2), (0.0, 200.0), strict=True):
        _draw_chain(axes, Motion(TOP, start(0.0, spin)))
        words = "turns" if spin else "grows along the nodes"
        axes.set_title(f"{spin:g} rad/s: $L$ {words}")
    axes = lower.subplots()
    times = np.linspace(0.0, 0.6, 1201)
    shades = (INK, RED, GOLD, GREY, BLUE, INK)
    for spin, color, dash in zip(SPINS, shades, ("-", "--", "-.", "--", "-", ":"), strict=True):
        theta = Motion(TOP, start(0.0, spin)).at(times).euler_angles.theta
        axes.plot(times, np.degrees(theta), color=color, ls=dash, label=f"{spin:g} rad/s")
    axes.set(xlabel="$t$ (s)", ylabel=r"$\theta$ (degrees)", xmargin=0, yticks=range(0, 181, 45))
    words = "no spin: the axis swings\nthrough straight down,\nand comes up on the\nother side"
    axes.annotate(words, (0.17, 178), (0.22, 176), va="top", arrowprops={"arrowstyle": "-"})
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), title=r"$\dot\psi(0)$")
    return figure


def _draw_chain(axes: Axes, motion: Motion) -> None:
    """Draw the horizontal L and the torque times dt of each step, head to tail, from above."""
    middles = STEP * (np.arange(STEPS) + 0.5)
    change = 1e3 * STEP * motion.top.gravity_torque(motion.at(middles))[:, :2]
    first = 1e3 * motion.top.angular_momentum(motion.start)[:2]
    tails = first + np.vstack([np.zeros(2), np.cumsum(change, axis=0)[:-1]])
    look: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "zorder": 3}
    last = tails[-1] + change[-1]
    axes.quiver(0, 0, *last, color=BLUE, label=f"$L$ after {STEP * STEPS:g} s", **look)
    label = rf"$\tau\,dt$ in steps of {1e3 * STEP:g} ms"
    if np.any(first):
        axes.quiver(0, 0, *first, color=INK, label="$L$ at the start", **look)
    else:  # the chain lies on L
        tails = tails + np.array([0.0, BESIDE])
        label += ", moved up"
    axes.quiver(*tails.T, *change.T, color=GOLD, label=label, **look)
    axes.plot(0, 0, "+", color=INK)
    axes.set(aspect="equal", xlim=(-1, 9), ylim=(-6.2, 4.6), xlabel="$L_{x'}$ ($10^{-3}$ N m s)")
    axes.set_ylabel("$L_{y'}$ ($10^{-3}$ N m s)")
    axes.legend(loc="upper right", fontsize=8)
