"""The kind of motion after a start with theta' = 0, decided by algebra, and the map of kinds.

The article ends its section 3.3 with the remark that initial values do not say which kind follows.
With theta' = 0 they do. phi' = (p_phi - p_psi u)/(Ix (1 - u^2)) vanishes at u = cos(theta) =
p_phi/p_psi only, and the axis gets there if the height there costs less than E'.
"""

from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from symtop_ros.arrays import Real
from symtop_ros.judge.figures import GREY, INK, RED, new_figure
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, Measured, claim
from workshop.article.motions import FAST, PSI_DOT, SLOW, THETA, TOP, start

TWICE = 2.0  # Mgl/p_psi: phi' of the second cusp, over the textbook's rate of precession
TRIED, SEED = 400, 20210330  # random starts, the same every time
NEAR = 1e-6  # relative distance from a boundary, on each side of it
ROUNDED = 1e-13  # rad/s, roots of a quadratic and rounding of phi' at a cusp. Measured: 2e-14
PHI_DOTS, PSI_DOTS = (-60.0, 120.0), (-400.0, 400.0)  # rad/s, of the map
KINDS = {"unidirectional": "#f3ede0", "looping": "#cfe1f2"}
POINTS = 900  # along a side of the map
LOOKS: dict[str, Any] = {
    "cusps": {"color": RED, "lw": 1.8},
    "regular precession": {"color": INK, "lw": 1.8, "ls": "--"},
    "through the vertical": {"color": GREY, "lw": 1.4, "ls": ":"},
}


def claims_on_starts(top: Top) -> list[Claim]:
    """Return the claims on kinds of motion that follow from a start with theta' = 0."""
    return [start_decides(top), random_starts_decide(top), second_cusp_is_twice_as_fast(top)]


def loops(top: Top, theta: Any, phi_dot: Any, psi_dot: Any) -> Any:
    """Return True where a start with theta' = 0 leads to loops: phi' reverses."""
    sine2, u = np.sin(theta) ** 2, np.cos(theta)
    p_psi = top.Iz * (psi_dot + phi_dot * u)
    p_phi = top.Ix * phi_dot * sine2 + p_psi * u
    # Both sides times p_psi^2, so that no spin is no exception
    reaches = (phi_dot * p_psi - TWICE * top.Mgl) * phi_dot * p_psi > 0
    return (np.abs(p_phi) < np.abs(p_psi)) & reaches


def find_boundaries(top: Top) -> tuple[float, float, float]:
    """Return phi' in rad/s at the second cusp, through the upper pole and through the lower one."""
    u, Ix, Iz = np.cos(THETA), top.Ix, top.Iz
    # phi' p_psi = 2 Mgl with p_psi = Iz (psi' + phi' u); the root that a fast top has
    cusp = max(np.roots([Iz * u, Iz * PSI_DOT, -TWICE * top.Mgl]).real, key=lambda x: x * top.Mgl)
    upper = Iz * PSI_DOT / (Ix * (1 + u) - Iz * u)
    lower = -Iz * PSI_DOT / (Ix * (1 - u) + Iz * u)
    return float(cusp), float(upper), float(lower)


@claim
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


@claim
def random_starts_decide(top: Top) -> Measured:
    """Check the rule for random tops and starts, by the kind of the motion."""
    random, good, looping = np.random.default_rng(SEED), 0, 0
    for k in range(TRIED):
        Iz, weight = random.uniform(0.1, 1.9), random.uniform(20.0, 200.0) * random.choice([-1, 1])
        each = Top(top.Ix, Iz * top.Ix, weight * top.Ix) if k else top
        theta, psi_dot = random.uniform([0.2, 30.0], [2.9, 300.0]).tolist()
        # on both sides of the two cusps, which lie at 0 and about 1
        phi_dot = random.uniform(-1.0, 2.0) * 2 * each.Mgl / (each.Iz * psi_dot)
        state = State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)
        expected = bool(loops(each, theta, phi_dot, psi_dot))
        kind = Motion(each, state).kind
        good += kind == ("looping" if expected else "unidirectional")
        looping += expected
    return Measured(
        good == TRIED and 0.1 * TRIED < looping < 0.9 * TRIED, good=good, looping=looping
    )


@claim
def second_cusp_is_twice_as_fast(top: Top) -> Measured:
    """Check the cusp above the start, and that its start has twice the textbook's rate."""
    rate, _, _ = find_boundaries(top)
    motion = Motion(top, start(rate))
    p_psi = float(top.axial_momentum(motion.start))
    far = motion.at(motion.nutation_period / 2)
    stopped, ratio = abs(float(far.euler_rates.phi)), rate * p_psi / top.Mgl
    angle = float(far.euler_angles.theta)
    holds = f"{angle:.4f}" == "0.3844" and abs(ratio - 2) < ROUNDED and stopped < ROUNDED * FAST
    return Measured(
        holds, rate=rate, ratio=ratio, angle=angle, stopped=stopped, limit=ROUNDED * FAST
    )


def find_curves(top: Top, phi_dot: Real) -> dict[str, list[Real]]:
    """Return psi' of the boundaries over phi' (n,) at the article's tilt, by their names."""
    u, Ix, Iz = np.cos(THETA), top.Ix, top.Iz
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


def draw_map_of_kinds(top: Top = TOP) -> Figure:
    """Draw the kinds over psi' and phi' for theta' = 0 at the article's tilt, with the curves."""
    figure = new_figure(4.6)
    axes = figure.subplots()
    phi_dot, psi_dot = np.linspace(*PHI_DOTS, POINTS), np.linspace(*PSI_DOTS, POINTS)
    looping = loops(top, THETA, phi_dot[:, np.newaxis], psi_dot)
    image: Any = {"extent": (*PSI_DOTS, *PHI_DOTS), "origin": "lower", "aspect": "auto"}
    colors = ListedColormap(list(KINDS.values()))
    axes.imshow(looping, cmap=colors, vmin=0, vmax=1, interpolation="nearest", **image)
    for name, color in KINDS.items():
        axes.fill_between([], [], facecolor=color, edgecolor=GREY, lw=0.5, label=name)
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
