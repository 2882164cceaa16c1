"""Mixed columns of quaternions are named as a person can undo them, all 384 of them."""

import re
from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
from trials import choose
from truth.judge.cases import Made, heading

from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.truth import scene_truth

TRUTH = scene_truth("cusps")
STAMPS = 1_034_217_000 + np.arange(400) * 7_000_000
NAMES = "wxyz"
NOISE = 1e-3  # rad
EVERY = [*product(permutations(range(4)), product((1, -1), repeat=4))]
# A half turn of the world or of the body, which is said as one.
ROTATIONS = re.compile("a (?:heading|rotation) of|forward-right-down|looks like noise")
SAID = {  # sentences that stand for one permutation: places and signs of what the columns hold
    "have the order x, y, z, w": ((1, 2, 3, 0), (1, 1, 1, 1)),
    "are conjugate: world to body": ((0, 1, 2, 3), (-1, 1, 1, 1)),
    "are conjugate, in the order x, y, z, w": ((1, 2, 3, 0), (-1, -1, -1, 1)),
}


def mix(q, places, signs):
    return q[:, list(places)] * np.array(signs)


def read(note):
    """Return the places and signs that a sentence names, as a person would read it."""
    said = [each for text, each in SAID.items() if text in note]
    if said:
        return said[0]
    places, signs = [0, 1, 2, 3], [1, 1, 1, 1]
    said, _, same = note.partition(" (the same as the other sign of ")
    for part in said.partition("mixed up: ")[2].split(", and "):
        columns, held = (find_columns(each) for each in re.split(" hold | are | has | have ", part))
        for column, name in zip(columns, held or columns[::-1], strict=True):
            if "sign" in part:  # what is said to be the same is the others
                signs[column] = -1
                assert {*columns} | {*find_columns(same)} == {*range(4)}
            else:
                places[column] = name
    return tuple(places), tuple(signs)


def find_columns(text):
    """Return the places of the columns that are named."""
    return [NAMES.index(name) for name in re.findall(r"\b[wxyz]\b", text)]


def assert_named(places, signs, made):
    """Assert that what is said of mixed columns undoes them, or is a rotation."""
    right = replace(made, noise=NOISE).make(TRUTH, STAMPS)
    wrong = replace(
        right, orientations=mix(right.orientations, places, signs), angular_velocities=None
    )
    judgement = judge(wrong, TRUTH, "x")
    text = judgement.format()
    assert judgement.found.explained, text
    assert judgement.found.best.residual < 2 * NOISE  # sqrt(3) of it are the noise
    if not any(words in text for words in ("mixed up", *SAID)):
        assert ROTATIONS.search(text)
        return False
    said_places, said_signs = read(text.partition("likely mistake: ")[2].partition(", or")[0])
    again = mix(right.orientations, said_places, said_signs)
    # the same attitudes: equal but for one sign of the whole
    assert np.abs((again * wrong.orientations).sum(axis=1)) == pytest.approx(1.0, abs=1e-12)
    return True


SOME = [7, 308]


@pytest.mark.slow
@pytest.mark.parametrize("number", choose(range(len(EVERY)), SOME))
def test_mixed_columns_are_named_so_that_they_can_be_undone(number):
    places, signs = EVERY[number]
    assert_named(places, signs, Made())


NEXT = {"heading": Made(world=heading(0.4)), "delay": Made(delay=0.0123), "drift": Made(drift=0.1)}


@pytest.mark.parametrize("name", choose(NEXT, ("delay",)))
def test_a_sign_is_named_next_to_another_cause(name):
    assert assert_named((0, 1, 2, 3), (1, -1, 1, 1), NEXT[name])
