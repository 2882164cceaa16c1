"""The article's motions in 3D: each as `top_replay` draws it from a log, and two scenes of many.

In a scene each top stands at a place with its trace and its turning circles; the plots below
compare theta of the tops in a column of the scene.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from symtop_ros.base.arrays import Stamps
from symtop_ros.physics import Motion, State, Top, hurry
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.blueprint import PLOT_BACKGROUND, around_cursor
from symtop_ros.replay.view.surroundings import Trace, create_stand, turning_circles
from symtop_ros.replay.view.view import View, ViewOptions
from symtop_ros.replay.viewer import create_recording
from symtop_ros.run.log.batch import Batch, Columns
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.changes.outcomes import Outcome, Start
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import STATE_TOPICS, Samples
from workshop.article.motions import (
    FAST,
    HURRIED,
    RATES,
    TOP,
    KickedMotion,
    cusps,
    regular,
    start,
)
from workshop.article.rates import FACTOR

RATE, SPAN = 500, 3.0  # Hz, s
KICK = 0.5  # s; time at which the kicked tops are kicked
TRACE = 1.0  # s of the trace that stay visible: a turn of the slow precession
SPREAD, DEPTH = 2.7, 1.5  # of columns and rows, in scene units
COLORS = {"rises": entities.BLUE, "stays": entities.WHITE, "falls": entities.ORANGE}
PALE = (150, 156, 168)  # of the turning circles: no colour of a direction
# A narrow eye from far away shows all tops from the same side. One of 55 degrees, which is the
# default of Rerun, skews the tops at the sides.
EYE = np.array([0.0, -16.0, 11.5])
TARGET = np.array([0.0, 0.0, 0.3])
NARROW = np.radians(12.0)
CAMERA = "/tops/eye"
ANGLES, TORQUES = ViewOptions(angles=True), ViewOptions(torques=True)
MOTIONS: dict[str, tuple[State, ViewOptions]] = {
    "below_slow_root": (start(3.0), ANGLES),
    "regular_precession": (regular().start, ANGLES),
    "above_slow_root": (start(9.0), ANGLES),
    "below_fast_root": (start(67.0), ANGLES),
    "fast_precession": (start(FAST), ANGLES),
    "above_fast_root": (start(73.0), ANGLES),
    "cusps": (cusps().start, ANGLES),
    "torque_of_regular_precession": (regular().start, TORQUES),
    "torque_of_cusps": (cusps().start, TORQUES),
}


@dataclass(frozen=True, slots=True)
class Exhibit:
    """One top of the scene."""

    name: str  # of its entities: letters, digits and underscores
    label: str  # shown above it, and for its curve
    group: str  # of the plot that its curve is in; a name of an entity too
    place: tuple[float, float]  # x and y of its pivot in scene units
    color: tuple[int, int, int]  # of its trace and its curve
    run: KickedMotion

    @property
    def root(self) -> str:
        """Path of the entity above all entities of the top."""
        return f"/tops/{self.name}"


def six_rates(top: Top = TOP) -> list[Exhibit]:
    """Return the six rates: three about the slow root in front, three about the fast one behind."""
    return [
        Exhibit(
            name=f"rate_{k + 1}",
            label=f"{rate.phi_dot:.3g} rad/s: {rate.direction}",
            group="fast_root" if k > 2 else "slow_root",
            place=((k % 3 - 1) * SPREAD, DEPTH if k > 2 else -DEPTH),
            color=COLORS[rate.direction],
            run=KickedMotion.of(Motion(top, start(rate.phi_dot))),
        )
        for k, rate in enumerate(RATES)
    ]


def kicked_and_not_kicked() -> list[Exhibit]:
    """Return three regular precessions twice: hurried after half a second, and not."""
    exhibits = []
    for k, (name, case) in enumerate(HURRIED.items()):
        steady = KickedMotion.of(case.begin())
        hurried = steady.kick(KICK, lambda state: hurry(state, FACTOR))
        x = (k - 1) * SPREAD
        words = f"{_title(name)}, hurried: {case.direction}"
        color = COLORS[case.direction]
        exhibits += [
            Exhibit(f"{name}_steady", "not kicked", name, (x, DEPTH), entities.WHITE, steady),
            Exhibit(f"{name}_hurried", words, name, (x, -DEPTH), color, hurried),
        ]
    return exhibits


def write_scene(exhibits: Sequence[Exhibit], file: Path) -> None:
    """Write a scene as a Rerun recording."""
    recording = create_recording(file, file.stem)
    recording.send_blueprint(_lay_out(exhibits))
    stream = entities.Stream(recording)
    stream.origin = 0
    _place_eye(stream)
    for exhibit in exhibits:
        _send(stream, exhibit)
    recording.flush()
    recording.disconnect()


def _place_eye(stream: entities.Stream) -> None:
    """Send a camera at `EYE`; a view that tracks it takes over its place and its angle."""
    forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(forward, right), forward], axis=1)  # right, down, forward
    stream.log(CAMERA, rr.Transform3D(translation=EYE, mat3x3=axes), static=True)
    pinhole = rr.Pinhole(
        fov_y=NARROW,
        aspect_ratio=1.0,
        camera_xyz=rr.ViewCoordinates.RDF,
        image_plane_distance=0.01,  # its outline is drawn in front of the eye, without a width
        line_width=0.0,
    )
    stream.log(CAMERA, pinhole, static=True)


def _send(stream: entities.Stream, exhibit: Exhibit) -> None:
    root = exhibit.root
    top = exhibit.run.pieces[0][1].top
    stream.log(root, rr.Transform3D(translation=(*exhibit.place, 0.0)), static=True)
    stream.log_mesh(f"{root}/top", entities.create_body(top), static=True)
    if top.Mgl > 0:
        stream.log_mesh(f"{root}/stand", create_stand(), static=True)
    grid = [entities.draw_parallel(angle) for angle in np.radians([15, 30, 45, 60, 75, 90])]
    sphere = rr.LineStrips3D(grid, colors=[entities.GREY], radii=[0.003])
    stream.log(f"{root}/sphere", sphere, static=True)
    label = rr.Points3D(
        [(0.0, 0.0, 1.45)],
        labels=[exhibit.label],
        colors=[entities.lighten(exhibit.color)],
        radii=[0.001],
    )
    stream.log(f"{root}/label", label, static=True)
    for begin, motion in exhibit.run.pieces:
        stream.set_time(round(begin * 1e9))
        stream.log(f"{root}/circles", turning_circles(motion.turning_angles, PALE))
    _send_motion(stream, exhibit)


def _send_motion(stream: entities.Stream, exhibit: Exhibit) -> None:
    root = exhibit.root
    stamps = np.arange(round(RATE * SPAN) + 1) * (10**9 // RATE)
    states = exhibit.run.at(np.asarray(stamps * 1e-9))
    stream.send_turns(f"{root}/top", stamps, states.orientation[:, [1, 2, 3, 0]])
    trace = Trace()
    trace.length = TRACE
    stream.style_lines(f"{root}/trace", exhibit.color, 0.012)
    stream.send_lines(f"{root}/trace", *trace.strips(stamps, states.to_world([0.0, 0.0, 1.0])))
    curve = f"/{exhibit.group}/{exhibit.name}"
    line = rr.SeriesLines(names=[exhibit.label], colors=[exhibit.color], widths=[2.0])
    stream.log(curve, line, static=True)
    stream.send_scalars(curve, stamps, np.asarray(states.euler_angles.theta)[:, None])


def _title(group: str) -> str:
    return group.replace("_", " ")


def _lay_out(exhibits: Sequence[Exhibit]) -> rrb.Blueprint:
    visible = around_cursor(-TRACE, 0.0)
    scene = rrb.Spatial3DView(
        origin="/tops",
        name="side by side",
        background=entities.BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(tracking_entity=CAMERA),
        overrides={f"{exhibit.root}/trace": visible for exhibit in exhibits},
    )
    groups = dict.fromkeys(exhibit.group for exhibit in exhibits)
    plots = [
        rrb.TimeSeriesView(
            origin=f"/{group}",
            name=f"theta, {_title(group)} (rad)",
            plot_legend=rrb.Corner2D.RightTop,
            background=PLOT_BACKGROUND,
        )
        for group in groups
    ]
    return rrb.Blueprint(
        rrb.Vertical(scene, rrb.Horizontal(*plots), row_shares=[5, 2]),
        rrb.TimePanel(timeline=entities.TIMELINE, state="collapsed", play_state="playing"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


SCENES = {"six_rates": six_rates, "kicked": kicked_and_not_kicked}


def write_recordings(folder: Path) -> None:
    """Write each of the `MOTIONS` and the `SCENES` as a Rerun recording NAME.rrd."""
    top = regular().top
    for name, (state, options) in MOTIONS.items():
        _record(Motion(top, state), options, folder / f"{name}.rrd")
    for name, exhibits in SCENES.items():
        write_scene(exhibits(), folder / f"{name}.rrd")


def _record(motion: Motion, options: ViewOptions, file: Path) -> None:
    """Write the scene of a motion as `top_replay` draws it from a log."""
    recording = create_recording(file, file.stem)
    segment = Segment.begin(motion, 0, 1.0)
    stamps = np.arange(round(RATE * SPAN) + 1) * (10**9 // RATE)
    start = sample("start", Start.of(motion), motion.start, segment, stamps)
    view = View(recording, options=options)
    view.send(start)
    recording.flush()
    view.close()


def sample(name: str, outcome: Outcome, before: State, segment: Segment, stamps: Stamps) -> Batch:
    """Return an event and the samples that follow it, as `TopLog` reads them from a log."""
    samples = Samples.at(segment, stamps)
    places = 1 + np.arange(len(stamps))
    columns = {
        topic: Columns(stamps, each.compute(samples), places)
        for topic, each in STATE_TOPICS.items()
    }
    change = Change(Act(name, int(stamps[0]), {}), before, segment, outcome)
    return Batch(columns, [(0, Event.of(change))])
