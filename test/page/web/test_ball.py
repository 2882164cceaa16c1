"""The suggestion of the ball: where it is, and nothing where it is not surely the ball."""

import base64
import math

import numpy as np
import pytest
from drawn import Numbers
from films import draw_balls, write_film

COUNT = 30
TIMES = [k / 60 for k in range(COUNT)]
# A ball of a film is drawn with 8 bits and packed by a codec.
NEAR = 0.3  # px


def swing(time):
    return 150 + 70 * math.cos(4 * time), 110 + 40 * math.sin(5 * time)


BALLS = [swing(time) for time in TIMES]


def follow(films, path, clicks=3, step=1, off=(0.0, 0.0)):
    """Return what is suggested after some clicks, each off the middle of the ball."""
    clicked = [
        [k, [BALLS[k][0] + off[0], BALLS[k][1] + off[1]]] for k in range(0, clicks * step, step)
    ]
    data = base64.b64encode(path.read_bytes()).decode()
    return films.evaluate("followBall", [data, path.name, clicked, step])


def write(tmp_path, pictures):
    return write_film(tmp_path / "a.webm", pictures, TIMES)


def check(found, frames, near=NEAR):
    assert [(frame, kind) for frame, kind, *_ in found] == [(k, "found") for k in frames]
    places = np.array([place for _, _, *place in found])
    assert np.abs(places - np.array(BALLS)[list(frames)]).max() < near


LOOKS = {
    "small": {"radius": 2.5},
    "large": {"radius": 20.0},
    "blue": {"colour": (30, 60, 220)},
    "black": {"colour": (20, 20, 20)},
    "pale": {"colour": (230, 200, 160)},
}


@pytest.mark.slow
@pytest.mark.parametrize("look", LOOKS)
def test_the_ball_is_found_to_a_third_of_a_pixel(films, look, tmp_path):
    path = write(tmp_path, draw_balls(BALLS, **LOOKS[look]))
    check(follow(films, path), range(3, COUNT))


def test_clicks_beside_the_middle_do_not_move_the_suggestion(films, tmp_path):
    path = write(tmp_path, draw_balls(BALLS))
    check(follow(films, path, off=(3.0, -2.0)), range(3, COUNT))


def test_frames_may_be_left_out(films, tmp_path):
    path = write(tmp_path, draw_balls(BALLS))
    check(follow(films, path, step=3), range(9, COUNT, 3))


@pytest.mark.slow
def test_noise_and_light_that_changes_do_not_lead_it_away(films, tmp_path):
    numbers = Numbers(5)
    noise = np.array([numbers.randint(-14, 14) for _ in range(320 * 240)]).reshape(240, 320, 1)

    def spoil(pictures):
        for k, picture in enumerate(pictures):
            dim = 1 - 0.15 * k / COUNT
            rolled = np.roll(noise, 37 * k)
            yield np.clip(np.round(picture * dim + rolled), 0, 255).astype(np.uint8)

    path = write(tmp_path, spoil(draw_balls(BALLS)))
    check(follow(films, path), range(3, COUNT), near=1.0)  # px, as a click of a hand


def test_a_wooden_disc_is_no_second_ball_though_it_is_half_like_it(films, tmp_path):
    def add_disc(pictures):
        for (x, y), picture in zip(BALLS, pictures, strict=True):
            left, top = round(x) - 40, round(y) + 14
            picture[top : top + 10, left : left + 80] = 150, 120, 80
            yield picture

    check(follow(films, write(tmp_path, add_disc(draw_balls(BALLS)))), range(3, COUNT))


def end(found):
    """Return the last frame and what is said of it."""
    return found[-1][:2]


def draw_with(change, at=12):
    """Yield the pictures, of which one is drawn by a change."""
    for k, picture in enumerate(draw_balls(BALLS)):
        yield change(k) if k == at else picture


def draw_one(*centres, **look):
    """Return a picture with some balls."""
    (picture,) = draw_balls(centres[:1], **look)
    for centre in centres[1:]:
        (other,) = draw_balls([centre], **look)
        picture = np.minimum(picture, other)
    return picture


CHANGES = {
    "none": lambda k: draw_one((-50, -50)),
    "second": lambda k: draw_one(BALLS[k], (BALLS[k][0] + 15, BALLS[k][1])),
    # exposed for so long that it moves by more than its size
    "blurred": lambda k: np.mean(
        [draw_one((BALLS[k][0] + s, BALLS[k][1] + s / 2)) for s in range(-9, 10)], axis=0
    ).astype(np.uint8),
    "half": lambda k: np.where(
        np.arange(320)[None, :, None] < BALLS[k][0], draw_one(BALLS[k]), draw_one((-50, -50))
    ),
    "away": lambda k: draw_one((BALLS[k][0] - 90, BALLS[k][1])),
}
SAID = {"none": "none", "second": "second", "blurred": "blurred", "half": "blurred", "away": "none"}


@pytest.mark.parametrize("name", CHANGES)
def test_there_is_no_suggestion_where_the_ball_is_in_doubt(films, name, tmp_path):
    path = write(tmp_path, draw_with(CHANGES[name]))
    assert end(follow(films, path)) == [12, SAID[name]]


def test_a_ball_that_is_not_told_from_the_ground_has_no_look(films, tmp_path):
    path = write(tmp_path, draw_balls(BALLS, colour=(196, 200, 200)))
    assert follow(films, path) == "no look"
