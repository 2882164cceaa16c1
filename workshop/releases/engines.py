"""Engines whose releases are scored, and the cases that their programs read."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from symtop_ros.models.descriptions import PLAIN, TURN, describe
from symtop_ros.models.snippets import STEPS, format_world_snippets
from symtop_ros.physics import STANDARD_GRAVITY, Body, State
from symtop_ros.testset.score import DESCRIPTIONS, read_problems
from workshop.releases.programs import PROGRAMS

# Older releases of Jolt have no body for the world: a static one of their own takes its place.
WORLD = "Jolt.JoltInterface.prototype.sGetFixedToWorldBody()"
GROUND = """system.GetBodyInterface().CreateBody(new Jolt.BodyCreationSettings(
  shape, new Jolt.RVec3(0, 0, 0), attitude, Jolt.EMotionType_Static, 0))"""


@dataclass(frozen=True)
class Engine:
    """An engine with releases in a registry; `engines.yaml` says what the fields are."""

    name: str
    package: str
    program: str
    form: str = ""  # of the models that it reads; empty: the program has the numbers
    described: tuple[str, ...] = ()  # problems of which all descriptions are run
    log: Mapping[str, str] = field(default_factory=dict)  # of changes, by release: a line of it

    @property
    def is_python(self) -> bool:
        """True if the package is from PyPI, False if it is from npm."""
        return bool(self.form)


ENGINES = tuple(
    Engine(name, **{**facts, "program": PROGRAMS[facts["program"]]})
    for name, facts in yaml.safe_load(
        Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
    ).items()
)


def list_cases(
    engine: Engine, levels: tuple[int, ...], names: frozenset[str]
) -> list[dict[str, Any]]:
    """Return what the program of an engine reads, for the problems and models that there are."""
    cases = []
    for name, problem in read_problems().items():
        facts = problem.facts
        if facts["level"] in levels or name in engine.described:
            described = ("", *DESCRIPTIONS) if name in engine.described else ("",)
            cases += [_write_case(engine, facts, each) for each in described]
    return [each for each in cases if not engine.form or each["model"] in names]


def _write_case(engine: Engine, facts: Mapping[str, Any], description: str) -> dict[str, Any]:
    body = Body(facts["mass"], facts["arm"], facts["Ix_centre"], facts["Iz"], STANDARD_GRAVITY)
    described = describe(description, body) if description else PLAIN
    plain = State(facts["orientation"], facts["angular_velocity"])
    start = described.begin(plain)
    place, velocity = described.find_origin(plain)
    x, y, _ = plain.angular_velocity.tolist()
    named, free = ".".join(filter(None, (facts["name"], description))), not facts["Mgl"]
    # A chain of joints has a pole.
    form = f"{'free.' if free and engine.package != 'pin' else ''}{engine.form}"
    chained = engine.form == "urdf" and facts["mujoco_urdf_effect"] is None
    snippets = format_world_snippets(plain, body, facts["times"][-1]).replace(WORLD, GROUND)
    programs = re.findall("```js\n(.*?)```", snippets, re.DOTALL)
    return {
        "name": named,
        "level": facts["level"],
        "model": "" if chained else f"{named}.{form}",
        "program": next((each for each in programs if f'"{engine.package}"' in each), ""),
        "times": facts["times"],
        "steps": STEPS,
        "step": facts["times"][0] / STEPS,
        "gravity": 0.0 if free else -STANDARD_GRAVITY,
        "free": free,
        "q": start.orientation.tolist(),
        "omega": start.angular_velocity.tolist(),
        "world_rates": plain.to_world(plain.angular_velocity).tolist(),
        "place": place,
        "velocity": velocity,
        "angles": list(plain.euler_angles),
        "rates": list(plain.euler_rates),
        "turn": list(map(float, TURN)) if described.turned else [1.0, 0.0, 0.0, 0.0],
        "mass": body.mass,
        "arm": body.arm,
        "moments": [body.Ix, body.Ix, body.Iz],
        "centre": plain.to_world([0.0, 0.0, body.arm]).tolist(),
        "centre_velocity": plain.to_world([body.arm * y, -body.arm * x, 0.0]).tolist(),
    }
