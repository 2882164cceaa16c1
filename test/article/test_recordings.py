"""The recordings of the article in the viewer: every view is drawn, and none reports an error."""

import numpy as np
import pytest
from pictures import pause_at, picture, running_viewer, view_named, views

from symtop_ros.article.recordings import MOTIONS, SCENES, write_recordings
from symtop_ros.playback.view import entities

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recordings")
    write_recordings(folder)
    return folder


@pytest.mark.parametrize("name", [*MOTIONS, *SCENES])
def test_a_recording_is_shown_without_errors(folder, name):
    with running_viewer(folder / f"{name}.rrd") as (client, _):
        view = view_named(client, "the top" if name in MOTIONS else "side by side")
        pause_at(client, entities.TIMELINE, duration=1.0)
        shot = picture(client, view)
        assert [each.reports for each in views(client, 1).values() if each.reports] == []
    assert len(np.unique(shot @ np.array([1, 256, 65536]))) > 500  # shaded bodies
