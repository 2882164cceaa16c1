"""The energy of a kick: into the spin, the weight, the precession, and E'.

E' = E - p_psi^2/(2 Iz) is what the spin does not keep. A kick at theta' = 0 puts energy into the
precession and, if it holds psi', into the spin; afterwards weight and precession exchange it.
"""

from dataclasses import astuple, dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.figure_style import BLUE, GOLD, INK, new_figure
from symtop_ros.physics import (
    Hold,
    Motion,
    State,
    Top,
    hurry,
    theta_acceleration,
)
from workshop.article.claims import Measured, claim
from workshop.article.motions import (
    HURRIED,
    THETA,
    TOP,
    HurryCase,
)
from workshop.article.rates import FACTOR

MILLI = 1e3  # mJ in a J
CLOSED = 1e-13  # of the energy; sums of rounded parts. Measured: 4e-16
HOLDS: dict[Hold, str] = {"spin_rate": "psi' held", "spin_momentum": "p_psi held"}
TITLES = {
    "slow_root": "the top at its slow root",
    "fast_root": "the top at its fast root",
    "disc": "the hanging disc at its slow root",
}
COLORS = {"weight": GOLD, "precession": BLUE, "E'": INK}


@dataclass(frozen=True, slots=True)
class Ledger:
    """Energy of a state in mJ, by what has it."""

    spin: float  # p_psi^2/(2 Iz)
    weight: float  # Mgl cos(theta)
    precession: float  # Ix phi'^2 sin^2(theta)/2
    nutation: float  # Ix theta'^2/2

    @classmethod
    def of(cls, top: Top, state: State) -> "Ledger":
        """Return the energies of a state."""
        theta = state.euler_angles.theta
        rates = state.euler_rates
        return cls(
            spin=MILLI * float(top.axial_momentum(state)) ** 2 / (2 * top.Iz),
            weight=MILLI * top.Mgl * float(np.cos(theta)),
            precession=MILLI * top.Ix * float(rates.phi_dot * np.sin(theta)) ** 2 / 2,
            nutation=MILLI * top.Ix * float(rates.theta_dot) ** 2 / 2,
        )

    def __sub__(self, other: "Ledger") -> "Ledger":
        """Return the changes from another state to this one."""
        pairs = zip(astuple(self), astuple(other), strict=True)
        return Ledger(*(mine - its for mine, its in pairs))

    @property
    def rest(self) -> float:
        """E' = E - p_psi^2/(2 Iz)."""
        return self.weight + self.precession + self.nutation

    @property
    def bars(self) -> dict[str, float]:
        """Return the energies that are drawn, by name."""
        return {"weight": self.weight, "precession": self.precession, "E'": self.rest}


@dataclass(frozen=True, slots=True)
class KickLedger:
    """Changes since before a kick in mJ: just after it, and at the far turning angle."""

    kick: Ledger
    far: Ledger
    total: float  # energy after the kick, by `Top.energy`; the sum of the parts should be it
    missed: float  # largest difference of that sum, relative

    @classmethod
    def of(cls, top: Top, before: State, after: State) -> "KickLedger":
        """Return the ledger of a kick from one state to another with theta' = 0."""
        motion = Motion(top, after)
        far = motion.at(motion.nutation_period / 2)
        first, second, third = (Ledger.of(top, state) for state in (before, after, far))
        total = MILLI * float(top.energy(after))
        sums = [part.spin + part.rest for part in (second, third)]
        missed = max(abs(each / total - 1) for each in sums)
        return cls(second - first, third - first, total, missed)


def hurry_ledger(top: Top, case: HurryCase, hold: Hold) -> KickLedger:
    """Return the ledger of a regular precession that is hurried."""
    before = case.begin(top)
    return KickLedger.of(before.top, before.start, hurry(before.start, FACTOR, hold))


# At the slow root, hurried by a factor of 1.4, in mJ: what the weight gains, the push puts into
# E', and the precession had; and what the push puts into the spin.
PRINTED: dict[Hold, tuple[str, str, str, str]] = {
    "spin_rate": ("1.93", "1.06", "0.87", "27.0"),
    "spin_momentum": ("1.90", "1.06", "0.84", "0.0"),
}


@claim(*HOLDS)
def precession_lifts(top: Top, hold: Hold) -> Measured:
    """Check how much of what lifts the hurried top comes from the push."""
    found = hurry_ledger(top, HURRIED["slow_root"], hold)
    lift = found.far.weight
    push = found.kick.rest
    spin = abs(found.kick.spin)
    words = f"{lift:.2f}", f"{push:.2f}", f"{-found.far.precession:.2f}", f"{spin:.1f}"
    printed = PRINTED[hold]
    holds = words == printed and found.missed < CLOSED
    return Measured(holds, held=HOLDS[hold], printed=printed, lift=lift, found=found)


@claim()
def hold_decides(_: Top) -> Measured:
    """Check the disc at its fast root: the axis rises with psi' held, and falls with p_psi held."""
    before = replace(HURRIED["disc"], root=1).begin()
    disc = before.top
    rate = before.start.euler_rates.phi_dot
    words, heights = [], []
    for hold in HOLDS:
        after = hurry(before.start, FACTOR, hold)
        rates = after.euler_rates
        found = float(theta_acceleration(disc, THETA, rates.phi_dot, rates.psi_dot))
        low, high = Motion(disc, after).turning_angles
        heights.append(disc.Mgl * (low + high - 2 * THETA) < 0)
        words.append(f"{found:+.0f}")
    return Measured(words == ["-592", "+901"] and heights == [False, True], rate=rate, words=words)


def draw_energy_ledger() -> Figure:
    """Draw the changes of energy by the kick of each case, for both holds."""
    figure = new_figure(6.4)
    grid = figure.subplots(len(TITLES), len(HOLDS), sharey="row", squeeze=False)
    for line, (name, title) in zip(grid, TITLES.items(), strict=True):
        for axes, (hold, words) in zip(line, HOLDS.items(), strict=True):
            ledger = hurry_ledger(TOP, HURRIED[name], hold)
            plot_ledger(axes, ledger)
            axes.set_title(f"{title},\n{words}: spin {ledger.kick.spin:+.1f} mJ", fontsize=9)
        line[0].set_ylabel("change (mJ)")
    handles = grid[0][0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper center", ncols=3)
    return figure


def plot_ledger(axes: Axes, ledger: KickLedger) -> None:
    """Plot weight, precession and E' just after a kick and at the far turning angle."""
    groups = (ledger.kick, ledger.far)
    for k, (name, color) in enumerate(COLORS.items()):
        heights = [group.bars[name] for group in groups]
        places = np.arange(len(groups)) + 0.27 * (k - 1)
        bars = axes.bar(places, heights, 0.25, color=color, label=name)
        labels = [f"{height:+.3g}" if height else "0" for height in heights]
        axes.bar_label(bars, labels, fontsize=8, padding=2)
    axes.set_axisbelow(True)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.set_xticks(range(len(groups)), ["just after the kick", "after half a nutation"])
    axes.grid(visible=False, axis="x")
    axes.margins(y=0.2)
