"""Sentences from records, and templates that fit them."""

import json
import math
import re
import typing
from dataclasses import fields
from itertools import chain

import pytest
from physics.tops import ARTICLE, SLOW, precess

from symtop_ros.physics import KickVerdict, Motion, hurry, kick_verdict, perrys_rule
from symtop_ros.physics.kicks import HOLDS
from symtop_ros.physics.rule.perry import Place, Reason
from symtop_ros.run.simulation.changes.outcomes import OUTCOMES
from symtop_ros.words import write
from symtop_ros.words.templates import FOLDER, PLACEHOLDER, TEMPLATES

pytestmark = pytest.mark.wording


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


def test_the_files_have_each_key_once_and_plain_placeholders():
    files = [
        json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"), object_pairs_hook=list)
        for name in ("en", "programs")
    ]
    for file in files:
        assert len(file) == len(dict(file))
    page, programs = map(dict, files)
    assert all("kick" in programs[key].lower() for key in page.keys() & programs.keys())
    pairs = [pair for file in files for pair in file]
    for _, template in pairs:
        assert not re.search(r"[{}]", PLACEHOLDER.sub("", template))


NUMBER = r"(-?\d[\d.]*(?:e[+-]\d+)?)"
PAIRS = f"{NUMBER} (?:instead of|to|->) {NUMBER}"


def read_numbers(text):
    return [float(each) for each in re.findall(NUMBER, text)]


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("nearness", [10.0**-n for n in range(1, 13)])
def test_two_numbers_that_differ_read_differently(nearness, hold):
    for rate in (SLOW * (1 + nearness), SLOW * (1 - nearness), 9.0):
        before = precess(rate)
        factor = 1 + nearness
        kicked = kick_verdict(Motion(ARTICLE, hurry(before, factor, hold)), before, hold)
        for verdict in (perrys_rule(ARTICLE, before, factor, hold), kicked):
            if verdict.reason.kind in ("hurried", "if_hurried"):
                pairs = re.findall(PAIRS, str(verdict))
                assert len(pairs) >= 2
                assert all(a != b for a, b in pairs), pairs
            if verdict.reason.place.kind in ("between", "outside"):
                assert len(set(read_numbers(write("place", verdict.reason.place)))) == 3


@pytest.mark.parametrize("off", [1e-3, 1e-5, -1e-5])
def test_a_top_that_moves_is_not_said_to_stay(off):
    verdict = perrys_rule(ARTICLE, precess(SLOW + off))
    assert verdict.direction in ("rises", "falls")
    for variant in ("radians", "degrees"):
        (span,) = re.findall("stay between .*?[.] ", write("verdict", verdict, variant))
        low, high = read_numbers(span)
        assert low < high


def test_angles_are_written_in_degrees_on_request():
    before = precess(9.0)
    kicked = kick_verdict(Motion(ARTICLE, hurry(before)), before, "spin_rate")
    text = write("kick", kicked, "degrees")
    low, high = map(math.degrees, kicked.turning_angles)
    assert f"theta will stay between {low:.1f}° and {high:.1f}°" in text
    assert " rad " not in text
    assert "rad/s" in text


def test_a_text_is_written_as_it_is():
    record = {"kind": "ended", "path": "a {path}  with {0:3f}", "failure": ""}
    assert write("record", record) == "recording to a {path}  with {0:3f} ended"
