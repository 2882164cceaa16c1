"""A body as MJCF and as an SDF world, held by a ball joint in the pivot, or by nothing.

SDF places the body; no element of it gives a body its first velocity, which therefore stands in a
comment.
"""

import math
from collections.abc import Iterator

from symtop_ros.physics import Body, State, Top
from symtop_ros.run.models.descriptions import (
    BACK,
    PLAIN,
    ROLL_PITCH_YAW,
    ROLL_PITCH_YAW_BACK,
    STEP,
    TURN,
    Description,
    Inertial,
    describe_body,
    join,
    measure_size,
)


def format_mjcf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as MJCF with a ball joint; its start is the keyframe "start"."""
    place = f' pos="{join([-each for each in described.pivot])}"' if described.is_moved else ""
    pivot = f' pos="{join(described.pivot)}"' if described.is_moved else ""
    joint = f'  <joint name="pivot" type="ball"{pivot}/>'
    q, omega = (each.tolist() for each in described.begin(start)._parts)
    lines = [f'<body name="top"{place}>', joint, *_fill(body, described), "</body>"]
    flag = '<flag contact="disable" constraint="disable"/>'
    return _write_mjcf(top, body, f"0 0 {-body.gravity!r}", flag, lines, q, omega)


def format_free_mjcf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as MJCF with a free joint; its start is the keyframe "start"."""
    place, velocity = described.find_origin(start)
    q, omega = (each.tolist() for each in described.begin(start)._parts)
    joint = '  <freejoint name="free"/>'
    lines = ['<body name="top">', joint, *_fill(body, described), "</body>"]
    flag = '<flag contact="disable"/>'
    qpos = [*place, *q]
    qvel = [*velocity, *omega]
    return _write_mjcf(top, body, "0 0 0", flag, lines, qpos, qvel)


def _write_mjcf(
    top: Top,
    body: Body,
    gravity: str,
    flag: str,
    lines: list[str],
    qpos: list[float],
    qvel: list[float],
) -> str:
    text = "\n".join(f"    {line}" for line in lines)
    return f"""<!-- {describe_body(top, body)} -->
<mujoco model="symtop">
  <compiler angle="radian"/>
  <option integrator="RK4" timestep="{STEP!r}" gravity="{gravity}">
    {flag}
  </option>
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
        yield f"  {_describe_part(described.link(body))}"
    if described == PLAIN:
        size = measure_size(body)
        end = math.copysign(size, body.arm)
        disc = f"{0.4 * size!r} {0.05 * size!r}"
        yield (
            f'  <geom type="capsule" fromto="0 0 0 0 0 {end!r}" size="{0.04 * size!r}" mass="0"/>'
        )
        yield f'  <geom type="cylinder" pos="0 0 {body.arm!r}" size="{disc}" mass="0"/>'
    if described.has_child:
        place = f'pos="{join(described.place_child())}" quat="{join(map(float, TURN))}"'
        yield f'  <body name="part" {place}>'
        yield f"    {_describe_part(described.part(body))}"
        yield "  </body>"


def _describe_part(part: Inertial) -> str:
    name = "fullinertia" if any(part.products) else "diaginertia"
    tensor = (*part.moments, *part.products) if any(part.products) else part.moments
    turn = f' quat="{join(BACK)}"' if part.is_principal else ""
    place = f'pos="{join(part.centre)}"{turn}'
    return f'<inertial {place} mass="{part.mass!r}" {name}="{join(tensor)}"/>'


def format_sdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as an SDF world with a ball joint."""
    local, world = _turn(described.begin(start))
    place = f"\n        <pose>{join(described.pivot)} 0 0 0</pose>" if described.is_moved else ""
    joint = f"""
      <joint name="pivot" type="ball">{place}
        <parent>world</parent>
        <child>top</child>
      </joint>"""
    words = f"""angular velocity {local} rad/s (frame of the body, and of Drake's ball
     joint, which is the pose below), {world} rad/s (world frame)."""
    return _write_sdf(top, start, body, described, f"0 0 {-body.gravity!r}", joint, words)


def format_free_sdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as an SDF world without a joint."""
    local, world = _turn(described.begin(start))
    words = f"""at rest in the origin, angular velocity {local} rad/s (frame of the
     body), {world} rad/s (world frame)."""
    velocity = join(described.find_origin(start)[1])
    moving = f"\n     The origin of the frame moves with {velocity} m/s (world frame)."
    words += moving if described.is_moved else ""
    return _write_sdf(top, start, body, described, "0 0 0", "", words)


def _turn(start: State) -> tuple[str, str]:
    """Return the angular velocity in the frames of the body and the world."""
    local = start.angular_velocity
    return join(local.tolist()), join(start.to_world(local).tolist())


def _write_sdf(
    top: Top,
    start: State,
    body: Body,
    described: Description,
    gravity: str,
    joint: str,
    words: str,
) -> str:
    w, x, y, z = described.begin(start).orientation.tolist()
    place = join(described.find_origin(start)[0]) if described.is_moved else "0 0 0"
    return f"""<?xml version="1.0"?>
<!-- {describe_body(top, body)}
     Start of the motion: {words} -->
<sdf version="1.9">
  <world name="symtop">
    <gravity>{gravity}</gravity>
    <physics name="fine" type="ignored">
      <max_step_size>{STEP!r}</max_step_size>
    </physics>
    <model name="top">
      <pose rotation_format="quat_xyzw">{place} {join((x, y, z, w))}</pose>
      <link name="top">
{_inertial(described.link(body))}{_draw(body) if described == PLAIN else ""}
      </link>{_join_child(body, described) if described.has_child else ""}{joint}
    </model>
  </world>
</sdf>
"""


def _inertial(part: Inertial) -> str:
    tensor = "".join(f"<{name}>{each!r}</{name}>" for name, each in part.tensor.items())
    turn = join(ROLL_PITCH_YAW_BACK) if part.is_principal else "0 0 0"
    return f"""\
        <inertial>
          <pose>{join(part.centre)} {turn}</pose>
          <mass>{part.mass!r}</mass>
          <inertia>{tensor}</inertia>
        </inertial>"""


def _draw(body: Body) -> str:
    size = measure_size(body)
    return f"""
        <visual name="axis">
          <pose>0 0 {math.copysign(size / 2, body.arm)!r} 0 0 0</pose>
          <geometry><cylinder><radius>{0.04 * size!r}</radius>\
<length>{size!r}</length></cylinder></geometry>
        </visual>
        <visual name="disc">
          <pose>0 0 {body.arm!r} 0 0 0</pose>
          <geometry><cylinder><radius>{0.4 * size!r}</radius>\
<length>{0.1 * size!r}</length></cylinder></geometry>
        </visual>"""


def _join_child(body: Body, described: Description) -> str:
    return f"""
      <link name="part">
        <pose>{join((*described.place_child(), *ROLL_PITCH_YAW))}</pose>
{_inertial(described.part(body))}
      </link>
      <joint name="fixed" type="fixed">
        <parent>top</parent>
        <child>part</child>
      </joint>"""
