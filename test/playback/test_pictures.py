"""Scenes rendered without a screen, compared with the log."""

import numpy as np
import pytest
import rerun.blueprint as rrb
from log_files import BEGIN, REGULAR, Run
from PIL import Image
from playback.view.rows import recording_to

from symtop_ros.physics import Motion, State, Top
from symtop_ros.playback.replay import replay
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.blueprint import EYE_UPPER_HALF, EYE_WHOLE_SPHERE
from symtop_ros.playback.view.view import View
from workshop.pictures import viewer
from workshop.pictures.viewer import pause_at, picture, running_viewer, view_named, views

VIEWS = 14
FOV = np.radians(55.0)  # vertical, Rerun's own
HANGING = Top(2.28e-4, 5.72e-5, -0.068)
SCENES = {
    "cusps": Run(seconds=1.5, hurried=False),
    "regular": Run(start=REGULAR, seconds=1.5, hurried=False),
    "hurried": Run(seconds=1.5),
    "hanging": Run(HANGING, State.from_euler(theta=0.6, phi_dot=1.0, psi_dot=100.0), hurried=False),
}


NAMES = [
    "hurried",
    *(pytest.param(name, marks=pytest.mark.long) for name in ("hanging", "cusps", "regular")),
]


@pytest.mark.parametrize("name", NAMES)
def test_a_replayed_log_shows_every_view_without_errors(name, tmp_path):
    target = tmp_path / f"{name}.rrd"
    replay(SCENES[name].open(tmp_path), target)
    with running_viewer(target) as (client, _):
        found = views(client, VIEWS)
        pause_at(client, entities.TIMELINE, duration=1.2)
        shot = picture(client)
        Image.fromarray(shot).save(tmp_path / f"{name}.png")
        assert {each.origin for each in found.values()} == {
            *(entities.SPACE, entities.PANEL, entities.EVENTS, entities.SENTENCE),
            *(entities.POTENTIAL, entities.CUBIC, *entities.PLOTS),
        }
        assert [each.reports for each in views(client, VIEWS).values()] == [[]] * VIEWS
        drawn = picture(client, found["the top"])
    assert len(np.unique(drawn.reshape(-1, 3), axis=0)) > 500  # shaded bodies, not an empty view


@pytest.mark.parametrize("size", ["1280x720", pytest.param("1600x900", marks=pytest.mark.long)])
def test_the_chart_of_the_potential_is_not_cut(size, tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "SIZE", size)
    target = tmp_path / "hurried.rrd"
    replay(SCENES["hurried"].open(tmp_path), target)
    with running_viewer(target) as (client, _):
        chart = view_named(client, "effective potential (J)")
        pause_at(client, entities.TIMELINE, duration=1.2)
        shot = picture(client, chart).astype(int)
    drawn = np.abs(shot - entities.BACKGROUND).max(axis=2) > 20
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    # the labels below the box end above the edge of the view, and little room is lost
    assert min(rows[0], columns[0]) > 0
    assert max(rows[-1] - len(drawn), columns[-1] - drawn.shape[1]) < -1
    assert rows[-1] - rows[0] > 0.8 * len(drawn)


def projected(point, eye, target, shape):
    """Pixel (x, y) of a point, seen from an eye with z up."""
    forward = np.subtract(target, eye)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    away = np.subtract(point, eye)
    height, width = shape[:2]
    scale = height / 2 / np.tan(FOV / 2) / (away @ forward)
    return np.array([width / 2 + scale * (away @ right), height / 2 - scale * (away @ up)])


@pytest.mark.parametrize("name", NAMES)
def test_the_axis_is_drawn_where_the_log_says(name, tmp_path):
    run = SCENES[name]
    eye, target = EYE_WHOLE_SPHERE if name == "hanging" else EYE_UPPER_HALF
    alone = rrb.Spatial3DView(
        origin=entities.SPACE,
        name="alone",
        contents=[entities.BODY],
        background=(0, 0, 255),
        line_grid=False,
        eye_controls=rrb.EyeControls3D(position=eye, look_target=target, eye_up=(0, 0, 1)),
    )
    with recording_to(tmp_path / "body.rrd") as recording:
        shown = View(recording)
        for batch in run.open(tmp_path).batches():
            shown.send(batch)
        recording.send_blueprint(rrb.Blueprint(alone, rrb.TimePanel(timeline=entities.TIMELINE)))
    with running_viewer(tmp_path / "body.rrd") as (client, _):
        view = view_named(client, "alone")
        for seconds in (0.2, 0.5, 0.7):
            pause_at(client, entities.TIMELINE, duration=seconds)
            shot = picture(client, view)
            axis = Motion(run.top, run.start).at(seconds).to_world([0.0, 0.0, 1.0])
            pivot = projected([0.0, 0.0, 0.0], eye, target, shot.shape)
            tip = projected(axis, eye, target, shot.shape)
            drawn = np.abs(shot.astype(int) - shot[0, 0]).max(axis=2) > 60
            drawn[:, shot.shape[1] * 4 // 5 :] = False  # where the viewer shows its own notes
            ys, xs = np.nonzero(drawn)
            along = (np.stack([xs, ys], axis=1) - pivot) @ (tip - pivot)
            end = np.array([xs[along.argmax()], ys[along.argmax()]])
            # half the width of the axle's end, and the edge of a pixel
            assert np.linalg.norm(end - tip) < 0.04 * np.linalg.norm(tip - pivot) + 2


def test_rerun_shows_the_turning_top_of_a_log_by_itself(tmp_path):
    path = Run(described=True).write(tmp_path)
    shots = []
    with running_viewer(path) as (client, _):
        for seconds in (0.2, 0.8):
            stamp = BEGIN * 1e-9 + seconds
            found = views(client, 4)
            pause_at(client, "message_log_time", timestamp=stamp)
            space = next(each for each in found.values() if each.view_class == "3D")
            shots.append(picture(client, space))
            assert not any(each.reports for each in views(client, 4).values())
    changed = np.abs(shots[0].astype(int) - shots[1]).max(axis=2) > 60
    assert changed.mean() > 0.005
