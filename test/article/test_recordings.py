"""The recordings: motions are what their labels say, and the viewer reports no error."""

import numpy as np

from workshop.article import recordings
from workshop.article.motions import RATES

TIMES = np.linspace(0.0, 2.0, 2001)


def tilts(exhibit):
    return np.asarray(exhibit.run.at(TIMES).euler_angles.theta)


def test_the_six_tops_do_what_their_labels_say():
    exhibits = recordings.six_rates()
    assert len({exhibit.place for exhibit in exhibits}) == len(RATES) == 6
    for exhibit in exhibits:
        change = tilts(exhibit) - 0.5
        low, high = change.min(), change.max()
        direction = exhibit.label.split(": ")[1]
        # the six motions change by 0.02 rad and more, those at the roots by rounding
        assert {"rises": low < -0.02, "falls": high > 0.02, "stays": high - low < 1e-9}[direction]


def test_until_the_kick_each_pair_is_one_motion_and_then_it_is_not():
    exhibits = recordings.kicked_and_not_kicked()
    for steady, hurried in zip(exhibits[::2], exhibits[1::2], strict=True):
        assert steady.place[0] == hurried.place[0]
        before = TIMES < recordings.KICK
        assert np.array_equal(tilts(steady)[before], tilts(hurried)[before])
        away = tilts(hurried)[~before] - tilts(steady)[~before]
        assert np.abs(away).max() > 1e-3
        assert hurried.label.endswith("rises" if away.min() < -1e-3 else "falls")
        assert np.ptp(tilts(steady)) < 1e-9
