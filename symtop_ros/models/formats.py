"""A top and its start as URDF, SDF and MJCF, the files that other engines read.

All of them hold a body that moves as the top does, with its doubles in full. Friction and
applied torques are left out: no format has friction that differs along and across the axis.

A top without weight turns about its centre of mass, and the pivot does nothing. Engines have code
of their own for free bodies, which a ball joint does not reach: such a body has models that nothing
holds, too.
"""

import math
from collections.abc import Callable, Sequence

from symtop_ros.models.urdf import describe_body, describe_inertial, robot_description
from symtop_ros.physics import Body, State, Top

STEP = 1e-4  # s; at 200 rad/s a step of 0.02 rad


def format_urdf(top: Top, start: State, body: Body) -> str:
    """Return the top as URDF: three revolute joints, since the format has no ball joint."""
    angles, rates = start.euler_angles, start.euler_rates
    text = robot_description(top, "world", "top", tf_moves_it=False, body=body)
    first, _, rest = text.partition("\n")
    return f"""{first}
<!--
     A heavy symmetric top with its pivot in the origin. URDF has no ball joint: three joints with
     the axes z-x-z (precession, tilt, spin) take its place. Start of the motion, in this order:
     position {angles.phi!r} {angles.theta!r} {angles.psi!r} rad, \
velocity {rates.phi!r} {rates.theta!r} {rates.psi!r} rad/s. The chain has its pole where the
     axis is vertical (tilt 0 or pi): a motion through it needs a ball joint.
-->
{rest}"""


def format_sdf(top: Top, start: State, body: Body) -> str:
    """Return the top as an SDF world with a ball joint.

    SDF places the body; no element of it gives a body its first angular velocity, which therefore
    stands in a comment.
    """
    pose, local, world = _place(start)
    return f"""<?xml version="1.0"?>
<!-- {describe_body(top, body)}
     Start of the motion: angular velocity {local} rad/s (frame of the body, and of Drake's ball
     joint, which is the pose below), {world} rad/s (world frame). -->
<sdf version="1.9">
  <world name="symtop">
    <gravity>0 0 {-body.gravity!r}</gravity>
    <physics name="fine" type="ignored">
      <max_step_size>{STEP!r}</max_step_size>
    </physics>
    <model name="top">
      <pose rotation_format="quat_xyzw">0 0 0 {pose}</pose>
{draw_body(body)}
      <joint name="pivot" type="ball">
        <parent>world</parent>
        <child>top</child>
      </joint>
    </model>
  </world>
</sdf>
"""


def _place(start: State) -> tuple[str, str, str]:
    """Return the pose of SDF, and the angular velocity in the frames of the body and the world."""
    w, x, y, z = start.orientation.tolist()
    rates = start.angular_velocity, start.to_world(start.angular_velocity)
    local, world = (join(each.tolist()) for each in rates)
    return join((x, y, z, w)), local, world


def draw_body(body: Body) -> str:
    """Return the link of an SDF model: inertia, and what is drawn."""
    size = measure_size(body)
    moments = f"<ixx>{body.Ix!r}</ixx><iyy>{body.Ix!r}</iyy><izz>{body.Iz!r}</izz>"
    return f"""\
      <link name="top">
        <inertial>
          <pose>0 0 {body.arm!r} 0 0 0</pose>
          <mass>{body.mass!r}</mass>
          <inertia>{moments}<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>
        </inertial>
        <visual name="axis">
          <pose>0 0 {math.copysign(size / 2, body.arm)!r} 0 0 0</pose>
          <geometry><cylinder><radius>{0.04 * size!r}</radius>\
<length>{size!r}</length></cylinder></geometry>
        </visual>
        <visual name="disc">
          <pose>0 0 {body.arm!r} 0 0 0</pose>
          <geometry><cylinder><radius>{0.4 * size!r}</radius>\
<length>{0.1 * size!r}</length></cylinder></geometry>
        </visual>
      </link>"""


def format_mjcf(top: Top, start: State, body: Body) -> str:
    """Return the top as MJCF with a ball joint; its start is the keyframe "start"."""
    size = measure_size(body)
    end = math.copysign(size, body.arm)
    disc = f"{0.4 * size!r} {0.05 * size!r}"
    return f"""<!-- {describe_body(top, body)} -->
<mujoco model="symtop">
  <compiler angle="radian"/>
  <option integrator="RK4" timestep="{STEP!r}" gravity="0 0 {-body.gravity!r}">
    <flag contact="disable" constraint="disable"/>
  </option>
  <worldbody>
    <light pos="0 0 {4 * size!r}" dir="0 0 -1"/>
    <body name="top">
      <joint name="pivot" type="ball"/>
      <inertial pos="0 0 {body.arm!r}" mass="{body.mass!r}" \
diaginertia="{body.Ix!r} {body.Ix!r} {body.Iz!r}"/>
      <geom type="capsule" fromto="0 0 0 0 0 {end!r}" size="{0.04 * size!r}" mass="0"/>
      <geom type="cylinder" pos="0 0 {body.arm!r}" size="{disc}" mass="0"/>
    </body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="{join(start.orientation.tolist())}" \
qvel="{join(start.angular_velocity.tolist())}"/>
  </keyframe>
</mujoco>
"""


FORMATS: dict[str, Callable[[Top, State, Body], str]] = {
    "urdf": format_urdf,
    "sdf": format_sdf,
    "mjcf": format_mjcf,
}


def measure_size(body: Body) -> float:
    """Return the length of the drawn axis in m: beyond the centre of mass, and near the body."""
    return max(abs(body.arm) / 0.6, 2 * math.sqrt(body.Ix / body.mass))


def join(numbers: Sequence[float]) -> str:
    """Return numbers in full, with spaces between them."""
    return " ".join(map(repr, numbers))


def format_free_mjcf(top: Top, start: State, body: Body) -> str:
    """Return the body as MJCF with a free joint; its start is the keyframe "start"."""
    qpos = join([0.0, 0.0, 0.0, *start.orientation.tolist()])
    qvel = join([0.0, 0.0, 0.0, *start.angular_velocity.tolist()])
    size = measure_size(body)
    return f"""<!-- {describe_body(top, body)} -->
<mujoco model="symtop">
  <compiler angle="radian"/>
  <option integrator="RK4" timestep="{STEP!r}" gravity="0 0 0">
    <flag contact="disable"/>
  </option>
  <worldbody>
    <light pos="0 0 {4 * size!r}" dir="0 0 -1"/>
    <body name="top">
      <freejoint name="free"/>
      <inertial pos="0 0 0" mass="{body.mass!r}" \
diaginertia="{body.Ix!r} {body.Ix!r} {body.Iz!r}"/>
      <geom type="capsule" fromto="0 0 0 0 0 {size!r}" size="{0.04 * size!r}" mass="0"/>
      <geom type="cylinder" size="{0.4 * size!r} {0.05 * size!r}" mass="0"/>
    </body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="{qpos}" qvel="{qvel}"/>
  </keyframe>
</mujoco>
"""


def format_free_sdf(top: Top, start: State, body: Body) -> str:
    """Return the body as an SDF world without a joint; its angular velocity is in a comment."""
    pose, local, world = _place(start)
    return f"""<?xml version="1.0"?>
<!-- {describe_body(top, body)}
     Start of the motion: at rest in the origin, angular velocity {local} rad/s (frame of the
     body), {world} rad/s (world frame). -->
<sdf version="1.9">
  <world name="symtop">
    <gravity>0 0 0</gravity>
    <physics name="fine" type="ignored">
      <max_step_size>{STEP!r}</max_step_size>
    </physics>
    <model name="top">
      <pose rotation_format="quat_xyzw">0 0 0 {pose}</pose>
{draw_body(body)}
    </model>
  </world>
</sdf>
"""


def format_free_urdf(top: Top, start: State, body: Body) -> str:
    """Return the body as URDF with one link; its start is in a comment."""
    w, x, y, z = start.orientation.tolist()
    return f"""<?xml version="1.0"?>
<!--
     One link: the engine gives it a floating base, and no gravity. Start of the motion:
     at rest in the origin, quaternion x, y, z, w {join((x, y, z, w))}, angular velocity \
{join(start.angular_velocity.tolist())} rad/s
     (frame of the body).
-->
<robot name="symtop">
  <link name="top">
    {describe_inertial(top, body)}
  </link>
</robot>
"""


FREE_FORMATS: dict[str, Callable[[Top, State, Body], str]] = {
    "free.urdf": format_free_urdf,
    "free.sdf": format_free_sdf,
    "free.mjcf": format_free_mjcf,
}
