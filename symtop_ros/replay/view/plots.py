"""The plots next to the 3D scene, the charts of the potential, and the table of the motion."""

import math
from collections.abc import Mapping
from dataclasses import asdict

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, Top, perrys_rule
from symtop_ros.replay.view import entities, quantities
from symtop_ros.replay.view.potential import PotentialView
from symtop_ros.replay.view.torques import Torques
from symtop_ros.run.log.batch import Columns
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.words.templates import write_number

RATE_OF_DOTS = 125.0  # positions per s of the clock
DRIFT_INTERVAL = 100_000_000  # ns between two curves of a potential that drifts
LINES = {
    entities.THETA: (["theta"], [entities.GOLD]),
    entities.PHI_DOT: (["phi'"], [entities.ORANGE]),
    entities.PSI_DOT: (["psi'"], [entities.GREEN]),
    entities.L: (["L_x'", "L_y'", "L_z'"], [entities.RED, entities.GREEN, entities.BLUE]),
    entities.L_HORIZONTAL: (["L\u00b2 - L_z'\u00b2"], [entities.BLUE]),
    entities.ENERGY: (
        ["kinetic", "+ potential", "+ lost to friction", "start + work"],
        [entities.GREEN, entities.GOLD, entities.RED, entities.WHITE],
    ),
    entities.NODES_TORQUE: (
        ["torque", "dL/dt in the body", "omega x L"],
        [entities.RED, entities.GREEN, entities.BLUE],
    ),
    entities.DRIFT: (["E", "L_z", "L_z'"], [entities.GOLD, entities.RED, entities.BLUE]),
}


class Plots:
    """The plots and the charts of the potential in a recording."""

    def __init__(self, stream: entities.Stream) -> None:
        self._stream = stream
        self._potential = PotentialView(stream)
        self._energy = quantities.EnergyBook()
        self._reference: Real | None = None  # constants of motion when the segment began
        for entity, (names, colors) in LINES.items():
            stream.log(
                entity,
                rr.SeriesLines(names=names, colors=colors, widths=[1.6] * len(names)),
                static=True,
            )

    def follow(self, event: Event, before: Segment | None, after: Segment, *, is_new: bool) -> None:
        """Take over an event; a new motion has another potential."""
        self._reference = None
        self._energy.follow(event, before, after)
        if after.motion.clamped:  # the hand changes p_phi, and with it the potential, all the time
            self._potential.remove()
        elif is_new:
            self._potential.log_motion(after.final_motion)

    def remove(self) -> None:
        """Remove what is drawn of a motion: from the current time on it is not known."""
        self._potential.remove()

    def send(self, columns: Mapping[str, Columns], segment: Segment | None) -> None:
        """Send the samples of a segment; without it (None) the motion is not known."""
        if "euler_angles" in columns:
            euler = columns["euler_angles"]
            for entity, column in (
                (entities.THETA, 1),
                (entities.PHI_DOT, 3),
                (entities.PSI_DOT, 5),
            ):
                self._stream.send_scalars(entity, euler.stamps, euler.numbers[:, [column]])
        if "angular_momentum" in columns:
            momentum = columns["angular_momentum"]
            self._stream.send_scalars(entities.L, momentum.stamps, momentum.numbers)
            # L^2 - L_z'^2, as L_x'^2 + L_y'^2, where nothing cancels
            square = (momentum.numbers[:, :2] ** 2).sum(axis=1, keepdims=True)
            self._stream.send_scalars(entities.L_HORIZONTAL, momentum.stamps, square)
        if segment:
            # pushes and a clamp change the constants
            if not (segment.motion.pushes or segment.motion.clamped):
                self._send_drift(columns, segment.motion.top)
            self._send_constants(columns, segment.motion)

    def _send_drift(self, columns: Mapping[str, Columns], top: Top) -> None:
        if found := quantities.constants(columns, top):
            stamps, values = found
            if self._reference is None:
                self._reference = values[0]
            scales = quantities.EPS * quantities.scales_of_constants(top, self._reference)
            self._stream.send_scalars(entities.DRIFT, stamps, (values - self._reference) / scales)

    def _send_constants(self, columns: Mapping[str, Columns], motion: Motion) -> None:
        """Send the moving dots of the potential, the energies and the inertial torque."""
        if "euler_angles" in columns and not motion.clamped:
            euler = columns["euler_angles"]
            step = quantities.find_step(euler.stamps, RATE_OF_DOTS)
            heights = quantities.heights_of_dots(motion.top, euler.numbers[::step])
            for entity, points in self._potential.place(*heights).items():
                self._stream.send(
                    f"{entity}/state", euler.stamps[::step], rr.Points2D.columns(positions=points)
                )
            if motion.is_driven:
                self._send_drifting_curves(euler, motion)
        parts = Torques.of(columns)
        for entity, found in (
            (entities.ENERGY, self._energy.rows(columns, motion)),
            (entities.NODES_TORQUE, (parts[0], parts[1].along_nodes()) if parts else None),
        ):
            if found:
                self._stream.send_scalars(entity, *found)

    def _send_drifting_curves(self, euler: Columns, motion: Motion) -> None:
        instants = np.unique(euler.stamps // DRIFT_INTERVAL, return_index=True)[1]
        potentials = quantities.potentials_at(motion.top, euler.numbers[instants])
        for entity, strips in self._potential.draw(potentials).items():
            self._stream.send(
                entity, euler.stamps[instants], rr.LineStrips2D.columns(strips=strips)
            )


def describe_motion(
    segment: Segment, state: State, scales: dict[str, str], equations: Mapping[str, str]
) -> str:
    """Return the table for the segment that begins with an event."""
    motion = segment.final_motion
    top = motion.top
    low, high = motion.turning_angles
    condition = _name_condition(segment)
    facts = {
        "motion": f"{motion.kind}, {f'speed {segment.factor:g}' if segment.running else 'paused'}",
        **({"angles and rates": condition} if condition else {}),
        "theta": f"{write_number(low, '4f')} .. {write_number(high, '4f')} rad",
        **({"precession": "held by hand"} if motion.clamped else _list_rates(motion, state)),
        "Ix, Iz; Mgl": f"{top.Ix:g}, {top.Iz:g} kg m\u00b2; {top.Mgl:g} J",
        **_added_torques(motion),
    }
    return _write_table({**facts, **_list_scales(scales), **equations})


def _name_condition(segment: Segment) -> str:
    """Return which forces angles and rates leave out, or when they hold; empty if they hold now."""
    motion = segment.motion
    if motion.is_driven:
        acting = {
            "friction": motion.friction,
            "the applied torque": any(motion.applied_torque),
            "later pushes": motion.pushes,
        }
        return f"without {' and '.join(name for name, acts in acting.items() if acts)}"
    return "after the last push" if motion.pushes else ""


def _list_rates(motion: Motion, state: State) -> dict[str, str]:
    # the table states that these numbers are those without friction and torque
    if motion.is_driven:
        motion = Motion(motion.top, motion.start)
    found = perrys_rule(motion.top, state).regular_rates
    rates = ", ".join(f"{rate:.4g}" for rate in found if not math.isnan(rate))
    return {
        "nutation": f"{_number(motion.nutation_period, 's')}, "
        f"{_number(motion.nutation_rate, 'rad/s')} "
        f"(p_psi/Ix: {_number(motion.fast_top_nutation_rate)})",
        "mean precession": f"{_number(motion.mean_precession_rate, 'rad/s')} "
        f"(Mgl/p_psi: {_number(motion.fast_top_precession_rate)})",
        "in a nutation": f"{_number(motion.precession_per_nutation, 'turns')}"
        + (", psi' changes sign" if motion.spin_reverses else ""),
        "regular precession": f"{rates or 'no'} rad/s",
    }


def describe_nothing(reason: str, scales: dict[str, str]) -> str:
    """Return the table where the motion is not known, for a reason."""
    return _write_table({"motion": f"not known: {reason}", **_list_scales(scales)})


def _list_scales(scales: dict[str, str]) -> dict[str, str]:
    return {f"1 unit of {', '.join(scales)}": ", ".join(scales.values())} if scales else {}


def _write_table(facts: Mapping[str, str]) -> str:
    rows = (f"| {name} | **{value}** |" for name, value in facts.items())
    return "\n".join(["| | |", "|---|---|", *rows])


def _added_torques(motion: Motion) -> dict[str, str]:
    """Return friction and applied torque."""
    if not motion.is_driven:
        return {}
    friction = asdict(motion.friction)
    sizes = ", ".join(f"{each:g}" for each in friction.values())
    return {
        f"friction {', '.join(friction)}": f"{sizes} N m s",
        "applied torque": "{:g} {:g} {:g} N m".format(*motion.applied_torque),
    }


def _number(value: float, unit: str = "") -> str:
    return f"{value:.5g} {unit}".rstrip() if math.isfinite(value) else "-"
