"""Sentences from records, and templates that fit them."""

import json
import math
import re
import typing
from dataclasses import fields, is_dataclass
from itertools import chain

import pytest
from physics.tops import ARTICLE, precess

from symtop_ros.physics import (
    Friction,
    KickVerdict,
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
    regular_precession_rates,
)
from symtop_ros.physics.kicks import HOLDS
from symtop_ros.physics.rule.perry import Place, Reason
from symtop_ros.simulation.changes.outcomes import OUTCOMES, Parameters, Setting
from symtop_ros.wording import templates, write
from symtop_ros.wording.templates import FILE, PLACEHOLDER, TEMPLATES

pytestmark = pytest.mark.wording

DISC = Top(Ix=0.000228, Iz=0.000456, Mgl=-0.068)


def words_of(hint):
    """The words that a type hint allows."""
    if typing.get_origin(hint) is typing.Literal:
        return set(typing.get_args(hint))
    return set(chain.from_iterable(map(words_of, typing.get_args(hint))))


@pytest.mark.parametrize(
    ("record", "field", "form"),
    [(Reason, "kind", "reason"), (Place, "kind", "place"), (KickVerdict, "axis", "change"),
     (KickVerdict, "direction", "does"), (KickVerdict, "subject", "subject")],
)  # fmt: skip
def test_every_word_of_a_record_has_a_template(record, field, form):
    for word in words_of(typing.get_type_hints(record)[field]):
        assert f"{form}.{word}" in TEMPLATES


def test_every_event_and_kind_of_outcome_has_a_template():
    for name, record in OUTCOMES.items():
        kinds = words_of(typing.get_type_hints(record).get("kind", None))
        for key in {f"{name}.{kind}" for kind in kinds} or {name}:
            assert key in TEMPLATES


def test_every_template_names_fields_of_its_record():
    records = {name: {each.name for each in fields(record)} for name, record in OUTCOMES.items()}
    for key, template in TEMPLATES.items():
        known = records.get(key.partition(".")[0])
        if known:
            assert {
                name for names, _ in PLACEHOLDER.findall(template) for name in names.split(",")
            } <= known


def test_the_file_has_each_key_once_and_plain_placeholders():
    pairs = json.loads(FILE.read_text(encoding="utf-8"), object_pairs_hook=list)
    keys = [key for key, _ in pairs]
    assert len(keys) == len(set(keys))
    for _, template in pairs:
        assert not re.search(r"[{}]", PLACEHOLDER.sub("", template))


def test_a_verdict_states_range_rule_and_average():
    assert str(perrys_rule(ARTICLE, precess(9.0))) == (
        "The top rises: theta will stay between 0.439 and 0.500 rad. Perry's rule holds: hurried "
        "from 9.00 to 12.60 rad/s, theta'' would be -110 instead of -48 rad/s^2 (9.00 rad/s lies "
        "between the regular rates 6.50 and 69.82 rad/s at this spin rate). On average phi' is "
        "6.42 rad/s, 0.157 turns in a nutation "
        "(slow precession of a fast top: Mgl/p_psi = 5.72 rad/s)."
    )


def test_angles_that_read_the_same_are_written_once():
    slow, _ = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    assert "theta will stay at 0.500 rad." in str(perrys_rule(ARTICLE, precess(slow)))


NUMBER = r"(-?\d[\d.]*(?:e[+-]\d+)?)"
PAIRS = f"{NUMBER} (?:instead of|to|->) {NUMBER}"


def read_numbers(text):
    return [float(each) for each in re.findall(NUMBER, text)]


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("nearness", [10.0**-n for n in range(1, 13)])
def test_two_numbers_that_differ_read_differently(nearness, hold):
    slow, _ = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    for rate in (slow * (1 + nearness), slow * (1 - nearness), 9.0):
        before, factor = precess(rate), 1 + nearness
        kicked = kick_verdict(Motion(ARTICLE, hurry(before, factor, hold)), before, hold)
        for verdict in (perrys_rule(ARTICLE, before, factor, hold), kicked):
            if verdict.reason.kind in ("hurried", "if_hurried"):
                pairs = re.findall(PAIRS, str(verdict))
                assert len(pairs) == 2
                assert all(a != b for a, b in pairs), pairs
            if verdict.reason.place.kind in ("between", "outside"):
                assert len(set(read_numbers(write("place", verdict.reason.place)))) == 3


@pytest.mark.parametrize("off", [1e-3, 1e-5, -1e-5])
def test_a_top_that_moves_is_not_said_to_stay(off):
    slow, _ = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
    verdict = perrys_rule(ARTICLE, precess(slow + off))
    assert verdict.direction in ("rises", "falls")
    for variant in ("radians", "degrees"):
        low, high = read_numbers(write("verdict", verdict, variant).partition(". ")[0])
        assert low < high


def test_what_is_held_is_said_with_the_regular_rates():
    before = precess(9.0)
    said = {hold: str(perrys_rule(ARTICLE, before, 1.4, hold)) for hold in HOLDS}
    assert "the regular rates 6.50 and 69.82 rad/s at this spin rate)" in said["spin_rate"]
    at_momentum = perrys_rule(ARTICLE, before, 1.4, "spin_momentum").regular_rates
    rates = " and ".join(f"{rate:.2f}" for rate in at_momentum)
    assert f"the regular rates {rates} rad/s at this spin momentum)" in said["spin_momentum"]


def test_a_change_without_effect_is_no_kick_at_a_start():
    sphere, state = Top(1e-3, 1e-3, 0.2), State((0.5, 0.5, 0.5, 0.5), (0.0, 5.0, 0.0))
    reason = write("reason", perrys_rule(sphere, state).reason)
    assert "kick" not in reason
    assert "theta'' is the same at 5.00 as at 7.00 rad/s" in reason


def test_below_the_pivot_axis_and_centre_of_mass_are_named_apart():
    before = precess(5.0, psi_dot=-120.0)
    kicked = kick_verdict(Motion(DISC, hurry(before)), before, "spin_rate")
    for text in (str(perrys_rule(DISC, before)), str(kicked)):
        assert "The axis falls (and the centre of mass rises)" in text
        assert "for the axis and" in text


def test_a_driven_motion_has_turning_angles_without_friction():
    before = precess(9.0)
    motion = Motion(ARTICLE, hurry(before), Friction(axial=2e-6))
    text = str(kick_verdict(motion, before, "spin_rate"))
    assert "without friction and applied torque theta will stay between" in text
    assert text.endswith("lower.") or "On average" not in text


def test_facts_against_the_rule_are_joined():
    before = precess(30.0)
    text = str(kick_verdict(Motion(ARTICLE, hurry(before)), before, "spin_rate"))
    assert "Although Perry's rule holds, the highest point is lower. On average" in text


def test_an_impulse_on_the_vertical_has_an_answer():
    before = State((1, 0, 0, 0), (0.0, 0.0, 200.0))
    after = apply_impulse(ARTICLE, before, (1e-4, 0.0, 0.0))
    text = str(kick_verdict(Motion(ARTICLE, after), before, None))
    assert text.startswith("Kick on the vertical (motion: through the pole). The top falls: theta ")
    assert "Perry's rule says nothing: the precession rate is undefined on the vertical." in text


def test_angles_are_written_in_degrees_on_request():
    before = precess(9.0)
    kicked = kick_verdict(Motion(ARTICLE, hurry(before)), before, "spin_rate")
    text = write("kick", kicked, "degrees")
    low, high = map(math.degrees, kicked.turning_angles)
    assert f"theta will stay between {low:.1f}° and {high:.1f}°" in text
    assert " rad " not in text
    assert "rad/s" in text


def test_parameters_are_listed():
    changes = Parameters((Setting("top.Mgl", "-0.05"), Setting("hurry_factor", "1.5")))
    assert write("parameters", changes) == "top.Mgl is now -0.05; hurry_factor is now 1.5"


def test_a_text_is_written_as_it_is():
    record = {"kind": "ended", "path": "a {path}  with {0:3f}", "failure": ""}
    assert write("record", record) == "recording to a {path}  with {0:3f} ended"


def test_with_keys_for_templates_a_record_is_written_by_its_key(monkeypatch):
    monkeypatch.setattr(templates, "TEMPLATES", {key: key for key in TEMPLATES})
    assert str(perrys_rule(ARTICLE, precess(9.0))) == "verdict"
    assert is_dataclass(KickVerdict)
