"""The kind of motion after a start with theta' = 0, decided by algebra, and the map of kinds.

The article ends its section 3.3 with the remark that initial values do not say which kind follows.
theta'' at the start is one number, and does not: the kind depends on phi' at both turning angles,
and the second of these is known from the constants of motion alone. With theta' = 0 initial values
do. phi' = (p_phi - p_psi u)/(Ix (1 - u^2)) vanishes at u = cos(theta) = p_phi/p_psi only, and the
axis gets there if the height there costs less than E'.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import GREY, INK, RED, new_figure
from symtop_ros.physics import (
    EffectivePotential,
    Motion,
    State,
    Top,
    regular_precession_rates,
    theta_acceleration,
)
from workshop.article.claims import Measured, claim, differ
from workshop.article.motions import (
    FAST,
    HANGING_DISC,
    PSI_DOT,
    RATES,
    SLOW,
    THETA,
    TOP,
    accelerations,
    draw_top,
    measure_acceleration,
    start,
)

DISC = Top(HANGING_DISC.Ix, HANGING_DISC.Iz, -HANGING_DISC.Mgl)  # upright
LYING = np.pi - 0.5  # rad, below the horizontal
SAME_RATE = 1e-12  # rad/s; phi' of regular precession at the far turning angle. Measured: 3e-14
EQUAL = 1e-13  # of theta''; two rates that are rounded once. Measured: 4e-15
VIETA = 1e-14  # relative; two rounded roots
TURNED = 1e-14  # of U_eff; rounding of the angle. Measured: 5e-16
STEP_SHARE = 0.002  # of a nutation: its phase changes by 0.013 rad in a step
TWICE = 2.0  # Mgl/p_psi: phi' of the second cusp, over the textbook's rate of precession
TRIED, SEED = 400, 20210330  # random starts, the same every time
NEAR = 1e-6  # relative distance from a boundary, on each side of it
ROUNDED = 1e-13  # rad/s, roots of a quadratic and rounding of phi' at a cusp. Measured: 2e-14
PHI_DOTS, PSI_DOTS = (-60.0, 120.0), (-400.0, 400.0)  # rad/s, of the map
KINDS = {"unidirectional": "#f3ede0", "looping": "#cfe1f2"}
POINTS = 900  # along a side of the map
Extent = tuple[float, float, float, float]
LOOKS: dict[str, Any] = {
    "cusps": {"color": RED, "lw": 1.8},
    "regular precession": {"color": INK, "lw": 1.8, "ls": "--"},
    "through the vertical": {"color": GREY, "lw": 1.4, "ls": ":"},
}


@claim()
def six_rates_have_kinds(top: Top) -> Measured:
    """Check the kind of each of the six motions by phi' at both turning angles."""
    words, agrees = [], []
    for rate in RATES:
        motion = Motion(top, start(rate.phi_dot))
        near = rate.phi_dot
        far = float(motion.at(motion.nutation_period / 2).euler_rates.phi_dot)
        expected = "regular" if rate.direction == "stays" else "unidirectional"
        is_regular = abs(far - near) < SAME_RATE
        agrees.append(motion.kind == expected and is_regular == (expected == "regular"))
        agrees.append(near * far > 0)
        words.append(f"{near:.4g} to {far:.4g} {motion.kind}")
    return Measured(all(agrees), listed="; ".join(words))


@claim(0.0, -3.0)
def accelerations_do_not_decide(top: Top, phi_dot: float) -> Measured:
    """Check that two starts have the same three accelerations and different kinds.

    The parabola of theta'' takes each value at two rates, which have the sum of its roots.
    """
    partner = SLOW + FAST - phi_dot
    motions = [Motion(top, start(rate)) for rate in (phi_dot, partner)]
    first, second = (accelerations(top, motion.at([0.0]))[0] for motion in motions)
    off = differ(second, first)
    kinds = [motion.kind for motion in motions]
    lowest = [motion.turning_angles[1] for motion in motions]
    holds = off < EQUAL and kinds[0] != kinds[1]
    return Measured(holds, partner=partner, first=first, off=off, kinds=kinds, lowest=lowest)


@claim()
def constants_decide(top: Top) -> Measured:
    """Check that the effective potential alone gives the turning angles that the motion has."""
    offs, words = [], []
    for rate in (0.0, SLOW + FAST):
        motion = Motion(top, start(rate))
        potential = EffectivePotential.from_state(top, motion.start)
        reached = motion.at([0.0, motion.nutation_period / 2]).euler_angles.theta
        size = np.abs(potential.at(reached)).max()
        offs.append(float(np.abs(potential.at(reached) - potential.energy).max() / size))
        words.append(f"{min(reached):.3f} .. {max(reached):.3f} rad")
    return Measured(max(offs) < TURNED, listed=" and of ".join(words), off=max(offs))


@claim(
    ("a disc with Iz > Ix", THETA, DISC),
    ("the article's top below the horizontal", LYING),
)
def parabola_opens_downward(top: Top, name: str, theta: float, disc: Top | None = None) -> Measured:
    """Check the sign rule of the roots, and rising and falling, for (Ix - Iz) cos(theta) < 0."""
    top = disc or top
    a = (top.Ix - top.Iz) * float(np.cos(theta))
    b = top.Iz * PSI_DOT
    low, high = sorted(regular_precession_rates(top, theta, PSI_DOT))
    rates = [low - 5.0, (low + high) / 2, high + 5.0]
    starts = [State.from_euler(theta=theta, phi_dot=rate, psi_dot=PSI_DOT) for rate in rates]
    found = [measure_acceleration(Motion(top, each), STEP_SHARE) for each in starts]
    off = max(abs((low + high) * a / b - 1), abs(low * high * a / top.Mgl - 1))
    expected = theta_acceleration(top, theta, np.array(rates), PSI_DOT)
    good = np.array_equal(np.sign(found), [-1, 1, -1]) and np.allclose(found, expected, rtol=1e-9)
    holds = good and low < 0 < high and a < 0 and off < VIETA
    return Measured(holds, low=low, high=high, found=found, off=off)


def loops(top: Top, theta: Any, phi_dot: Any, psi_dot: Any) -> Any:
    """Return True where a start with theta' = 0 leads to loops: phi' reverses."""
    sine2 = np.sin(theta) ** 2
    u = np.cos(theta)
    p_psi = top.Iz * (psi_dot + phi_dot * u)
    p_phi = top.Ix * phi_dot * sine2 + p_psi * u
    # Both sides times p_psi^2, so that no spin is no exception
    reaches = (phi_dot * p_psi - TWICE * top.Mgl) * phi_dot * p_psi > 0
    return (np.abs(p_phi) < np.abs(p_psi)) & reaches


def find_boundaries(top: Top) -> tuple[float, float, float]:
    """Return phi' in rad/s at the second cusp, through the upper pole and through the lower one."""
    u = np.cos(THETA)
    Ix = top.Ix
    Iz = top.Iz
    # phi' p_psi = 2 Mgl with p_psi = Iz (psi' + phi' u); the root that a fast top has
    cusp = max(np.roots([Iz * u, Iz * PSI_DOT, -TWICE * top.Mgl]).real, key=lambda x: x * top.Mgl)
    upper = Iz * PSI_DOT / (Ix * (1 + u) - Iz * u)
    lower = -Iz * PSI_DOT / (Ix * (1 - u) + Iz * u)
    return float(cusp), float(upper), float(lower)


@claim()
def start_decides(top: Top) -> Measured:
    """Check the kinds of the article's top for every phi' at the start."""
    cusp, upper, lower = find_boundaries(top)
    changes = {0.0: "cusps", cusp: "cusps", SLOW: "regular", FAST: "regular"}
    edges = sorted([lower, 0.0, cusp, upper])
    expected = ["unidirectional", "looping", "unidirectional", "looping", "unidirectional"]
    found, agrees = [], []
    for low, high, kind in zip([-200.0, *edges], [*edges, 200.0], expected, strict=True):
        inside = np.linspace(low, high, 9)[1:-1]
        sides = [low + NEAR * abs(low), high - NEAR * abs(high), *inside.tolist()]
        kinds = {Motion(top, start(rate)).kind for rate in sides if rate not in (low, high, SLOW)}
        agrees.append(kinds == {kind})
        found.append(f"{low:.5g} to {high:.5g} {'/'.join(sorted(kinds))}")
    agrees += [Motion(top, start(rate)).kind == kind for rate, kind in changes.items()]
    words = f"{cusp:.3f}, {lower:.2f}, {upper:.2f}"
    return Measured(all(agrees) and words == "11.325, -146.46, 30.27", listed="; ".join(found))


@claim()
def random_starts_decide(top: Top) -> Measured:
    """Check the rule for random tops and starts, by the kind of the motion."""
    random = np.random.default_rng(SEED)
    good = 0
    looping = 0
    decided = 0
    cusped = 0
    for k in range(TRIED):
        drawn = draw_top(random, top)
        each = drawn if k else top
        if k % 2:  # the same with its weight below the pivot
            each = Top(each.Ix, each.Iz, -each.Mgl)
        theta, psi_dot = random.uniform([0.2, 30.0], [2.9, 300.0]).tolist()
        # on both sides of the two cusps, which lie at 0 and about 1
        phi_dot = random.uniform(-1.0, 2.0) * 2 * each.Mgl / (each.Iz * psi_dot)
        state = State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)
        expected = bool(loops(each, theta, phi_dot, psi_dot))
        kind = Motion(each, state).kind
        good += kind == ("looping" if expected else "unidirectional")
        looping += expected
        rate = random.uniform(0.3, 3.0) * float(np.sqrt(abs(each.Mgl) / each.Ix))
        has_cusp = has_second_cusp(each, theta, rate)
        decided += has_cusp == (start_at_second_cusp(each, theta, rate).kind == "cusps")
        cusped += has_cusp
    holds = good == decided == TRIED
    holds = holds and all(0.1 * TRIED < count < 0.9 * TRIED for count in (looping, cusped))
    return Measured(holds, good=good, looping=looping, decided=decided, cusped=cusped)


def has_second_cusp(top: Top, theta: float, phi_dot: float) -> bool:
    """Return True if phi' = 2 Mgl/p_psi leads to a cusp: |p_phi| < |p_psi|."""
    p_psi = TWICE * top.Mgl / phi_dot
    sign = np.sign(top.Mgl)
    return bool(p_psi**2 > 2 * top.Ix * abs(top.Mgl) * (1 + sign * np.cos(theta)))


def start_at_second_cusp(top: Top, theta: float, phi_dot: float) -> Motion:
    """Return the motion with theta' = 0 and p_psi = 2 Mgl/phi'."""
    psi_dot = TWICE * top.Mgl / phi_dot / top.Iz - phi_dot * float(np.cos(theta))
    return Motion(top, State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot))


@claim()
def second_cusp_is_twice_as_fast(top: Top) -> Measured:
    """Check the cusp above the start, and that its start has twice the textbook's rate."""
    rate, _, _ = find_boundaries(top)
    motion = Motion(top, start(rate))
    p_psi = float(top.axial_momentum(motion.start))
    far = motion.at(motion.nutation_period / 2)
    stopped = abs(float(far.euler_rates.phi_dot))
    ratio = rate * p_psi / top.Mgl
    angle = float(far.euler_angles.theta)
    holds = f"{angle:.4f}" == "0.3844" and abs(ratio - 2) < ROUNDED and stopped < ROUNDED * FAST
    return Measured(
        holds, rate=rate, ratio=ratio, angle=angle, stopped=stopped, limit=ROUNDED * FAST
    )


def find_curves(top: Top, phi_dot: Real) -> dict[str, list[Real]]:
    """Return psi' of the boundaries over phi' (n,) at the article's tilt, by their names."""
    u = np.cos(THETA)
    Ix = top.Ix
    Iz = top.Iz
    turned = phi_dot * u
    p_psi = TWICE * top.Mgl / phi_dot
    # Where phi' would vanish beyond the vertical there is no cusp
    reached = np.abs(Ix * phi_dot * np.sin(THETA) ** 2 + p_psi * u) < np.abs(p_psi)
    return {
        "cusps": [np.where(reached, p_psi / Iz - turned, np.nan)],
        "regular precession": [((Ix - Iz) * turned * phi_dot + top.Mgl) / (Iz * phi_dot)],
        "through the vertical": [
            Ix * (1 + u) / Iz * phi_dot - turned,
            -Ix * (1 - u) / Iz * phi_dot - turned,
        ],
    }


def draw_regions(
    axes: Axes, places: Any, colors: Mapping[str, str], extent: Extent, **edge: Any
) -> None:
    """Draw the region of each point of a grid, by its place among the colours, and their legend."""
    image: Any = {"extent": extent, "origin": "lower", "aspect": "auto", "interpolation": "nearest"}
    shades = ListedColormap(list(colors.values()))
    axes.imshow(places, cmap=shades, vmin=-0.5, vmax=len(colors) - 0.5, **image)
    for name, color in colors.items():
        axes.fill_between([], [], facecolor=color, label=name, **edge)


def draw_map_of_kinds(top: Top = TOP) -> Figure:
    """Draw the kinds over psi' and phi' for theta' = 0 at the article's tilt, with the curves."""
    figure = new_figure(4.6)
    axes = figure.subplots()
    phi_dot, psi_dot = np.linspace(*PHI_DOTS, POINTS), np.linspace(*PSI_DOTS, POINTS)
    looping = loops(top, THETA, phi_dot[:, np.newaxis], psi_dot)
    extent = (*PSI_DOTS, *PHI_DOTS)
    draw_regions(axes, looping, KINDS, extent, edgecolor=GREY, lw=0.5)
    # phi' = 0 is no point of a curve with 1/phi'
    for part in (phi_dot[phi_dot < 0], phi_dot[phi_dot > 0]):
        for name, curves in find_curves(top, part).items():
            for values in curves:
                label = name if part[0] > 0 and values is curves[0] else None
                axes.plot(values, part, label=label, **LOOKS[name])
    axes.axhline(0.0, **LOOKS["cusps"])
    for rate in (0.0, SLOW, find_boundaries(top)[0], FAST):
        axes.plot(PSI_DOT, rate, "o", color=INK, ms=4.5, zorder=3)
    axes.set(xlim=PSI_DOTS, ylim=PHI_DOTS, xlabel=r"$\dot\psi$ (rad/s)")
    axes.set_ylabel(r"$\dot\phi$ (rad/s) at the start, $\dot\theta = 0$")
    title = f"$\\theta = {THETA}$ rad; dots: the article's top at 0, {SLOW:.2f}, "
    axes.set_title(title + f"{find_boundaries(top)[0]:.2f} and {FAST:.1f} rad/s")
    figure.legend(loc="outside lower center", ncols=3)
    return figure
