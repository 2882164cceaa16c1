"""A body as MJCF, held by a ball joint in the pivot, or by nothing."""

import math
from collections.abc import Iterator

from symtop_ros.models.descriptions import (
    PLAIN,
    STEP,
    TURN,
    Description,
    Inertial,
    describe_body,
    join,
    measure_size,
)
from symtop_ros.physics import Body, State, Top


def format_mjcf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as MJCF with a ball joint; its start is the keyframe "start"."""
    place, joint = "", '<joint name="pivot" type="ball"/>'
    if described.is_moved:
        place = f' pos="{join([-each for each in described.pivot])}"'
        joint = f'<joint name="pivot" type="ball" pos="{join(described.pivot)}"/>'
    world = f"""\
  <option integrator="RK4" timestep="{STEP!r}" gravity="0 0 {-body.gravity!r}">
    <flag contact="disable" constraint="disable"/>
  </option>"""
    q, omega = (each.tolist() for each in described.begin(start).parts)
    lines = [f'<body name="top"{place}>', f"  {joint}", *_fill(body, described), "</body>"]
    return _write(top, body, world, lines, (q, omega))


def format_free_mjcf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as MJCF with a free joint; its start is the keyframe "start"."""
    world = f"""\
  <option integrator="RK4" timestep="{STEP!r}" gravity="0 0 0">
    <flag contact="disable"/>
  </option>"""
    place, velocity = described.find_origin(start)
    q, omega = (each.tolist() for each in described.begin(start).parts)
    lines = ['<body name="top">', '  <freejoint name="free"/>', *_fill(body, described), "</body>"]
    return _write(top, body, world, lines, ([*place, *q], [*velocity, *omega]))


def _write(
    top: Top, body: Body, world: str, lines: list[str], start: tuple[list[float], list[float]]
) -> str:
    qpos, qvel = start
    text = "\n".join(f"    {line}" for line in lines)
    return f"""<!-- {describe_body(top, body)} -->
<mujoco model="symtop">
  <compiler angle="radian"/>
{world}
  <worldbody>
    <light pos="0 0 {4 * measure_size(body)!r}" dir="0 0 -1"/>
{text}
  </worldbody>
  <keyframe>
    <key name="start" qpos="{join(qpos)}" qvel="{join(qvel)}"/>
  </keyframe>
</mujoco>
"""


def _fill(body: Body, described: Description) -> Iterator[str]:
    """Yield what is in the link: its inertia, what is drawn, and the child."""
    if described.share:
        yield f"  {_inertial(described.link(body))}"
    if described == PLAIN:
        size = measure_size(body)
        end, disc = math.copysign(size, body.arm), f"{0.4 * size!r} {0.05 * size!r}"
        yield (
            f'  <geom type="capsule" fromto="0 0 0 0 0 {end!r}" size="{0.04 * size!r}" mass="0"/>'
        )
        yield f'  <geom type="cylinder" pos="0 0 {body.arm!r}" size="{disc}" mass="0"/>'
    if described.has_child:
        place = f'pos="{join(described.place_child())}" quat="{join(map(float, TURN))}"'
        yield f'  <body name="part" {place}>'
        yield f"    {_inertial(described.part(body))}"
        yield "  </body>"


def _inertial(part: Inertial) -> str:
    name = "fullinertia" if any(part.products) else "diaginertia"
    tensor = (*part.moments, *part.products) if any(part.products) else part.moments
    return f'<inertial pos="{join(part.centre)}" mass="{part.mass!r}" {name}="{join(tensor)}"/>'
