"""Sentences that stand together deny each other in no language, and say what the motions do."""

import math
from collections import Counter

import numpy as np
import pytest
from page.web.directions import find_contradictions, read_facts
from page.web.modules import load_kernel
from page.web.test_kick_headlines import SAMPLED, draw_kicks, find_tilts, sample
from trials import choose, trials

from symtop_ros.page.web.join import LANGUAGES
from symtop_ros.physics import Motion, State, Top


def say(tab, language, cases):
    """Return what the page says of each case, all sentences in one text."""
    load_kernel(tab, language)
    try:
        return [" ".join(each) for each in tab.evaluate("sayAll", cases)]
    finally:
        load_kernel(tab)


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(100, 10_000))
@pytest.mark.parametrize("language", choose([*LANGUAGES], [*LANGUAGES]))
def test_without_their_labels_no_two_sentences_contradict_each_other(tab, language, count):
    cases = list(draw_kicks(count))
    heard = Counter()
    for case, text, english in zip(
        cases, say(tab, language, cases), say(tab, "en", cases), strict=True
    ):
        facts = list(read_facts(language, text))
        assert not find_contradictions(facts), (case, text)
        assert sorted(facts) == sorted(read_facts("en", english)), (text, english)
        heard.update(facts)
    ways = {(name, way) for name in ("axis", "mass", "highest", "lowest") for way in (1, -1)}
    ways |= {(name, way) for name in ("mean", "mean_mass") for way in (1, -1)}
    assert heard.keys() >= ways


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(60, 4000))
def test_each_way_that_is_said_is_that_of_the_sampled_motions(tab, count):
    cases = list(draw_kicks(count))
    states = [each["states"] for each in tab.evaluate("sayKicks", cases)]
    for case, text, pair in zip(cases, say(tab, "en", cases), states, strict=True):
        without, with_it = (sample(case["top"], state) for state in pair)
        facts = dict(read_facts("en", text))
        off = SAMPLED * max(with_it.range, without.range) + 1e-7
        changes = {
            "highest": without.top - with_it.top,
            "lowest": without.bottom - with_it.bottom,
            "mean": find_mean(case["top"], pair[1]) - find_mean(case["top"], pair[0]),
        }
        for name, change in changes.items():
            if name in facts and abs(change) > off:
                assert facts[name] == (1 if change > 0 else -1), (name, change, text)
        if facts.get("axis") and with_it.range > 5e-7:  # 1e-7 rad is not seen
            assert facts["axis"] == find_first(case["top"], pair[1]), text


def find_first(top, state):
    """Return the way of the axis as soon as its tilt differs by more than 1e-7 rad: 1 is up."""
    motion = Motion(Top(**top), State(*state))
    times = np.exp2(np.arange(-1200, 600) / 30) * math.sqrt(
        top["Ix"] / (abs(top["Mgl"]) or top["Ix"])
    )
    tilts = find_tilts(motion, times)
    now = find_tilts(motion, np.array([0.0]))[0]
    (left,) = np.nonzero(np.abs(tilts - now) > 1e-7)
    return 1 if tilts[left[0]] < now else -1


def find_mean(top, state):
    """Return the mean of cos(theta) over a nutation; nan if the motion does not return."""
    motion = Motion(Top(**top), State(*state))
    if not math.isfinite(motion.nutation_period):
        return math.nan
    times = np.linspace(0.0, motion.nutation_period, 2049)[:-1]
    _, x, y, _ = motion.at(times).orientation.T
    return float(np.mean(1 - 2 * (x * x + y * y)))
