"""A body as an SDF world, held by a ball joint in the pivot, or by nothing.

SDF places the body; no element of it gives a body its first velocity, which therefore stands in a
comment.
"""

import math

from symtop_ros.models.descriptions import (
    PLAIN,
    ROLL_PITCH_YAW,
    STEP,
    Description,
    Inertial,
    describe_body,
    join,
    measure_size,
)
from symtop_ros.physics import Body, State, Top


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
    return _write(top, start, body, described, f"0 0 {-body.gravity!r}", joint, words)


def format_free_sdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as an SDF world without a joint."""
    local, world = _turn(described.begin(start))
    words = f"""at rest in the origin, angular velocity {local} rad/s (frame of the
     body), {world} rad/s (world frame)."""
    if described.is_moved:
        velocity = join(described.find_origin(start)[1])
        words += f"\n     The origin of the frame moves with {velocity} m/s (world frame)."
    return _write(top, start, body, described, "0 0 0", "", words)


def _turn(start: State) -> tuple[str, str]:
    """Return the angular velocity in the frames of the body and the world."""
    rates = start.angular_velocity, start.to_world(start.angular_velocity)
    local, world = (join(each.tolist()) for each in rates)
    return local, world


def _write(
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
    return f"""\
        <inertial>
          <pose>{join(part.centre)} 0 0 0</pose>
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
