"""A body without weight as URDF, SDF and MJCF that nothing holds.

A top without weight turns about its centre of mass, and the pivot does nothing. Engines have code
of their own for free bodies, which a ball joint does not reach.
"""

from collections.abc import Callable

from symtop_ros.models.formats import STEP, draw_body, join, measure_size
from symtop_ros.models.urdf import describe_body, describe_inertial
from symtop_ros.physics import Body, State, Top


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
    w, x, y, z = start.orientation.tolist()
    local, world = (
        join(each.tolist())
        for each in (start.angular_velocity, start.to_world(start.angular_velocity))
    )
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
      <pose rotation_format="quat_xyzw">0 0 0 {join((x, y, z, w))}</pose>
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
