"""Engines whose releases are scored, and the cases that their programs read."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from symtop_ros.models.descriptions import PLAIN, TURN, describe
from symtop_ros.models.snippets import STEPS, format_world_snippets
from symtop_ros.physics import STANDARD_GRAVITY, Body, State
from symtop_ros.testset.score import DESCRIPTIONS, read_problems
from workshop.releases.programs import CANNON, DRAKE, MUJOCO, PINOCCHIO, PYBULLET, PYTHON, SNIPPETS

# Older releases of Jolt have no body for the world: a static one of their own takes its place.
WORLD = "Jolt.JoltInterface.prototype.sGetFixedToWorldBody()"
GROUND = """system.GetBodyInterface().CreateBody(new Jolt.BodyCreationSettings(
  shape, new Jolt.RVec3(0, 0, 0), attitude, Jolt.EMotionType_Static, 0))"""


@dataclass(frozen=True)
class Engine:
    """An engine with releases in a registry."""

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


# Lines of change logs, as far as they were read: those of MuJoCo to 3.12.0, of Rapier to 0.20.0.
MUJOCO_LOG = {
    "3.7.0": "Added midpoint integration for standalone free bodies in `implicit` and "
    "`implicitfast` integrators.",
    "3.8.1": "Midpoint integration is now restricted to the `implicitfast` integrator",
    "3.11.0": "Replaced midpoint integration of free bodies with gyroscopic derivatives in the "
    "`implicitfast` integrator",
}
RAPIER_LOG = {
    "0.20.0": "Update to Rapier 0.35.0 (whose log says: Gyroscopic forces are applied per-substep "
    "in the principal inertia frame)"
}
ENGINES = (
    Engine(
        "MuJoCo", "mujoco", PYTHON % MUJOCO, "mjcf", ("free_rod_fast", "gentle_looping"), MUJOCO_LOG
    ),
    Engine("pybullet", "pybullet", PYTHON % PYBULLET, "urdf", ("gentle_free", "gentle_looping")),
    Engine("cannon-es", "cannon-es", CANNON),
    Engine("Rapier", "@dimforge/rapier3d-compat", SNIPPETS, log=RAPIER_LOG),
    Engine("Jolt", "jolt-physics", SNIPPETS),
    Engine("Pinocchio", "pin", PYTHON % PINOCCHIO, "urdf", ("gentle_looping",)),
    Engine("Drake", "drake", PYTHON % DRAKE, "sdf", ("free_rod_fast", "gentle_looping")),
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
