"""Scenes rendered without a screen, compared with the log."""

import numpy as np
import pytest
from log_files import BEGIN, REGULAR, Run
from PIL import Image
from trials import choose
from waiting import until

from symtop_ros.physics import State, Top
from symtop_ros.replay.view import entities
from symtop_ros.replay.viewer import replay
from workshop.pictures.viewer import pause_at, picture, running_viewer, views

VIEWS = 14
HANGING = Top(2.28e-4, 5.72e-5, -0.068)
SCENES = {
    "cusps": Run(seconds=1.5, hurried=False),
    "regular": Run(start=REGULAR, seconds=1.5, hurried=False),
    "hurried": Run(seconds=1.5),
    "hanging": Run(HANGING, State.from_euler(theta=0.6, phi_dot=1.0, psi_dot=100.0), hurried=False),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", choose(SCENES, ("hurried",)))
def test_a_replayed_log_shows_every_view_without_errors(name, tmp_path):
    target = tmp_path / f"{name}.rrd"
    replay(SCENES[name].open(tmp_path), target)
    with running_viewer(target) as (client, _):
        found = views(client, VIEWS)
        pause_at(client, entities.TIMELINE, duration=1.2)
        shot = picture(client)
        Image.fromarray(shot).save(tmp_path / f"{name}.png")
        assert {each.origin for each in found.values()} == {
            entities.SPACE,
            entities.PANEL,
            entities.EVENTS,
            entities.SENTENCE,
            entities.POTENTIAL,
            entities.CUBIC,
            *entities.PLOTS,
        }
        assert [each.reports for each in views(client, VIEWS).values()] == [[]] * VIEWS
        drawn = picture(client, found["the top"])
    assert len(np.unique(drawn.reshape(-1, 3), axis=0)) > 500  # shaded bodies, not an empty view


@pytest.mark.slow
def test_rerun_shows_the_turning_top_of_a_log_by_itself(tmp_path):
    path = Run(described=True).write(tmp_path)
    shots = []
    with running_viewer(path) as (client, _):
        for seconds in (0.2, 0.8):
            stamp = BEGIN * 1e-9 + seconds
            # the 3D view among four, once Rerun has read what it draws there
            (space,) = until(lambda: [v for v in views(client, 4).values() if v.view_class == "3D"])
            pause_at(client, "message_log_time", timestamp=stamp)
            shots.append(picture(client, space))
            assert not any(each.reports for each in views(client, 4).values())
    changed = np.abs(shots[0].astype(int) - shots[1]).max(axis=2) > 60
    assert changed.mean() > 0.005
