"""Runs of the page for tests: a good one, and hostile ones from the table of its fields."""

import json
import tempfile
from pathlib import Path

from physics.tops import ARTICLE, CUSPS

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import ExactTimes, Friction, Motion, hurry
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.run_file import RunEvent, read_run, write_run

START = Motion(ARTICLE, CUSPS)
KICK = {"precession_rate_factor": 1.4, "hold": "spin_rate"}
# None of these is a good value of any field.
HOSTILE = (None, True, [], {}, [None], ["0"] * 3, [[0], [0], [0], [0]], 10**400, [10**400] * 3)
WORDS = ("", "__proto__", "constructor", "<script>", "0", "1e999")
TEXTS = ("x" * 1000,)


def make_run():
    """A start, a kick at an odd nanosecond, and friction with a torque."""
    kicked = Motion(ARTICLE, hurry(START.at(ExactTimes(1234567891)), 1.4))
    driven = Motion(ARTICLE, kicked.at(ExactTimes(987654321)), Friction(1e-6), (0.0, 0.0, 5e-4))
    return [
        RunEvent("start", 0, START, {}),
        RunEvent("kick", 1234567891, kicked, KICK),
        RunEvent("change", 2222222212, driven, {}),
    ]


def to_json(events):
    return json.loads(json.dumps([event.to_json() for event in events]))


def change(place, **values):
    """Return the run with other values in one of its events."""
    content = json.loads(json.dumps(write_run(make_run(), 3_000_000_000)))
    content["events"][place].update(values)
    return content


def list_hostile_runs():
    """Return runs with a hostile value in each field of the kick, with the names of the fields."""
    runs = []
    for name, field in TABLE["event"].items():
        values = (*HOSTILE, *(TEXTS if "length" in field else WORDS), *_list_beyond(field))
        values = [value for value in values if not ("flag" in field and value is True)]
        runs += [(name, change(1, **{name: value})) for value in values]
    for name, field in TABLE["act"].items():
        values = (*HOSTILE, *WORDS, *_list_beyond(field))
        runs += [(name, change(1, act={**KICK, name: value})) for value in values]
    runs += [("act", change(1, act=value)) for value in HOSTILE if value != {}]
    runs += [("field name", change(1, act={name: 1})) for name in ("__proto__", "speed")]
    return runs


def _list_beyond(field):
    """Return values next to the limits of a field, and lists of another length."""
    if "size" in field:
        return [[2 * int(field["limit"])] * field["size"], [0] * (field["size"] + 1)]
    return [field["low"] - 1e-9, 2 * field["high"]] if "low" in field else []


def find_refusal(content):
    """Return the refusal of a run by the reader of Python."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "run.json")
        path.write_text(json.dumps(content))
        try:
            read_run(path)
        except RefusedError as error:
            return str(error)
    return ""
