"""Headlines and curves of a page."""

import json
import math

import numpy as np
import pytest

from symtop_ros.panel.actions import Actions
from symtop_ros.panel.source import LocalTop
from symtop_ros.simulation.presets import describe_scenes, scene_names
from symtop_ros.web.facts import compare, describe, thin
from symtop_ros.web.run import Run


@pytest.fixture(name="played")
def _played(monkeypatch):
    """Actions on a paused top, its run, and a function that takes over what happened."""
    now = [0.0]
    monkeypatch.setattr("symtop_ros.panel.source.time.monotonic", lambda: now[0])
    top, run = LocalTop("hurry_slow", factor=0.1), Run()
    top.watch(True)

    def look():
        for _ in range(3):
            now[0] += 0.02
            run.follow(top.batch())

    look()
    actions = Actions(top, run)
    actions.pause()
    look()
    yield actions, run, look
    top.close()


def headline_after(played, act):
    actions, run, look = played
    act(actions)
    look()
    return compare(run.announced)


def test_headlines_compare_both_limits_with_those_without_the_kick(played):
    for factor, kind in ((1.4, "higher"), (1 / 1.4, "lower")):
        headline = headline_after(played, lambda actions, factor=factor: actions.kick(factor))
        assert (headline.kind, round(headline.most, 3)) == (kind, 0.063)
    # A push of the axle upwards makes steady precession nutate to both sides.
    wider = headline_after(played, lambda actions: actions.push("up"))
    assert wider.kind == "wider"
    _, run, _ = played
    low, high = run.motion.turning_angles
    assert low < 0.5 < high
    back = headline_after(played, lambda actions: actions.push("down"))
    assert back.kind == "narrower"


def test_a_second_hurry_that_falls_and_yet_lifts_both_limits_is_a_rise(played):
    actions, run, look = played
    actions.kick(1.4)
    look()
    for _ in range(30):
        actions.step()
        look()
        if run.state.euler_rates.theta > 1.0:
            break
    before = run.motion.turning_angles
    actions.kick(1.4)
    look()
    after = run.motion.turning_angles
    moved = [was - now for was, now in zip(before, after, strict=True)]
    kind = "higher" if min(moved) >= -1e-7 else "lower" if max(moved) <= 1e-7 else "wider"
    assert compare(run.announced).kind == kind
    assert kind != "lower"


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_has_a_headline_and_a_curve_below_its_energy(played, name):
    actions, run, look = played
    actions.choose_scene(name)
    look()
    facts = describe(run)
    json.dumps(facts, allow_nan=False)  # nothing that a browser cannot read
    potential = facts["potential"]
    low, high = potential["angles"]
    tilts, heights = (np.array(potential[key]) for key in ("theta", "height"))
    inside = heights[(tilts > low) & (tilts < high)]
    scale = abs(potential["energy"]) + abs(run.motion.top.Mgl)
    # E' and U are sums of a few terms of this size, each with a rounding of 1e-16.
    assert (inside <= potential["energy"] + 1e-13 * scale).all()


def test_every_scene_has_a_title_and_a_story():
    scenes = describe_scenes()
    assert [scene.name for scene in scenes] == list(scene_names())
    assert len({scene.title for scene in scenes}) == len(scenes)
    for scene in scenes:
        assert 3 < len(scene.title) < 40
        assert scene.story.endswith(".")


def test_a_plot_gets_few_rows_and_the_newest_digits():
    times = np.linspace(0.0, 1.0, 20_001)
    rows = np.column_stack([times, *(np.full(len(times), 0.123456789),) * 6, times * math.nan])
    chosen = thin(rows, window=1.0)
    assert 480 <= len(chosen) <= 482
    assert chosen[7][1:] == [0.123457, 0.123457, 0.123457, None]


@pytest.mark.wording
def test_headline_and_verdict_do_not_contradict_each_other_and_are_given_in_degrees(played):
    actions, run, look = played
    actions.kick(1.4)
    look()
    facts = describe(run)
    assert facts["headline"] == "The top moves higher than without the kick, by 0.063 rad."
    assert facts["degrees"]["headline"].endswith("by 3.61°.")
    assert "between 25.0° and 28.6°" in facts["degrees"]["why"]
    assert facts["why"] == run.announced.event.verdict


@pytest.mark.wording
def test_a_headline_under_friction_says_that_its_limits_are_without_it(played):
    actions, run, look = played
    actions.choose_scene("friction")
    look()
    assert "without friction and applied torque" in describe(run)["headline"]


def test_the_history_lists_requests_with_three_digits(played):
    actions, run, look = played
    actions.kick(1.23456789)
    look()
    (entry, *_) = describe(run)["history"]
    assert entry[1] == "kick: precession_rate_factor=1.23"
