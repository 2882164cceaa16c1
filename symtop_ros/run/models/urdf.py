"""The URDF of the top: three joints with axes z-x-z, and a body with its moments of inertia.

The joints have the names of ~/euler_angles, so that robot_state_publisher can move them. A frame
may have one parent only. If the node publishes /tf, the body is therefore the frame that /tf moves,
joined to the world by a floating joint, which robot_state_publisher leaves alone; the chain of the
joints ends in an empty link. If the node does not publish /tf, the chain ends in the body.
"""

import html  # xml.sax.saxutils would import http and ssl
import math

from symtop_ros.physics import Body, State, Top
from symtop_ros.run.models.descriptions import (
    PLAIN,
    ROLL_PITCH_YAW,
    ROLL_PITCH_YAW_BACK,
    Description,
    Inertial,
    describe_body,
    join,
)

# What an empty link needs in MuJoCo, in kg and in kg m^2: mjMINVAL. No other engine reads it.
MUJOCO_BOUND = 1e-15
# pybullet gives 1 kg to a link without inertia; it accepts a zero.
MASSLESS = """<inertial>
      <mass value="0"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/>
    </inertial>"""
LENGTH = 0.1  # m, from the pivot to the upper end of the drawing


def robot_description(
    top: Top,
    world_frame: str,
    top_frame: str,
    *,
    tf_moves_it: bool = True,
    body: Body | None = None,
    described: Description = PLAIN,
) -> str:
    """Return the URDF of a top, with a body that moves as it does; by default one is chosen."""
    world_frame, top_frame = (
        html.escape(name, quote=False).replace('"', "&quot;") for name in (world_frame, top_frame)
    )
    end = f"{top_frame}_spin" if tf_moves_it else top_frame
    floating = f"""
  <link name="{end}"/>
  <joint name="tf" type="floating">
    <parent link="{world_frame}"/><child link="{top_frame}"/>
  </joint>"""
    axis = join(described.axis) if described.turned else "0 0 1"
    turned = f'<origin rpy="{join(ROLL_PITCH_YAW)}"/>' if described.turned else ""
    return f"""<?xml version="1.0"?>
<robot name="symtop">
  <material name="steel"><color rgba="0.55 0.6 0.66 1"/></material>
  <material name="brass"><color rgba="0.85 0.65 0.25 1"/></material>
  <material name="mark"><color rgba="0.75 0.15 0.1 1"/></material>
  <mujoco><compiler boundmass="{MUJOCO_BOUND}" boundinertia="{MUJOCO_BOUND}"/></mujoco>
  <link name="{world_frame}"/>
  <joint name="precession" type="continuous">
    <parent link="{world_frame}"/><child link="{top_frame}_precession"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="tilt" type="continuous">
    <parent link="{top_frame}_precession"/><child link="{top_frame}_tilt"/><axis xyz="1 0 0"/>
  </joint>
  <joint name="spin" type="continuous">
    <parent link="{top_frame}_tilt"/><child link="{end}"/>{turned}<axis xyz="{axis}"/>
  </joint>{floating if tf_moves_it else ""}
  <link name="{top_frame}">
    {describe_inertial(top, body, described)}{_draw(top) if described == PLAIN else ""}
  </link>{join_child(top_frame, body, described)}
  <link name="{top_frame}_precession">
    {MASSLESS}
  </link>
  <link name="{top_frame}_tilt">
    {MASSLESS}
  </link>
</robot>
"""


def describe_inertial(top: Top, body: Body | None, described: Description = PLAIN) -> str:
    """Return the inertia of the link, and the sentence that describes the body."""
    try:
        body = body or Body.from_top(top)
    except ValueError as error:
        return f"<!-- No body moves like this top: {html.escape(str(error), quote=False)}. -->"
    inertia = _inertial(described.link(body)) if described.share else MASSLESS
    return f"<!-- {describe_body(top, body)} -->\n    {inertia}"


def join_child(frame: str, body: Body | None, described: Description) -> str:
    """Return the fixed child with its joint; nothing without a child."""
    if not (body and described.has_child):
        return ""
    place = f'xyz="{join(described.place_child())}" rpy="{join(ROLL_PITCH_YAW)}"'
    return f"""
  <link name="{frame}_part">
    {_inertial(described.part(body))}
  </link>
  <joint name="fixed" type="fixed">
    <parent link="{frame}"/><child link="{frame}_part"/><origin {place}/>
  </joint>"""


def format_urdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as URDF: three revolute joints, since the format has no ball joint."""
    angles, (phi_dot, theta_dot, psi_dot) = start.euler_angles, start.euler_rates
    text = robot_description(top, "world", "top", tf_moves_it=False, body=body, described=described)
    first, _, rest = text.partition("\n")
    return f"""{first}
<!--
     A heavy symmetric top with its pivot in the origin. URDF has no ball joint: three joints with
     the axes z-x-z (precession, tilt, spin) take its place. Start of the motion, in this order:
     position {angles.phi!r} {angles.theta!r} {angles.psi!r} rad, \
velocity {phi_dot!r} {theta_dot!r} {psi_dot!r} rad/s. The chain has its pole where the
     axis is vertical (tilt 0 or pi): a motion through it needs a ball joint.
-->
{rest}"""


def format_free_urdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as URDF with one link, and its child; its start is in a comment."""
    state = described.begin(start)
    w, x, y, z = state.orientation.tolist()
    place, velocity = map(join, described.find_origin(start))
    moving = f"place {place} m and velocity {velocity} m/s of the frame (world),\n    "
    rest = moving if described.is_moved else "at rest in the origin"
    return f"""<?xml version="1.0"?>
<!--
     One link: the engine gives it a floating base, and no gravity. Start of the motion:
     {rest}, quaternion x, y, z, w {join((x, y, z, w))}, angular velocity \
{join(state.angular_velocity.tolist())} rad/s
     (frame of the body).
-->
<robot name="symtop">
  <link name="top">
    {describe_inertial(top, body, described)}
  </link>{join_child("top", body, described)}
</robot>
"""


def _inertial(part: Inertial) -> str:
    tensor = " ".join(f'{name}="{each!r}"' for name, each in part.tensor.items())
    turn = f' rpy="{join(ROLL_PITCH_YAW_BACK)}"' if part.is_principal else ""
    return f"""<inertial>
      <origin xyz="{join(part.centre)}"{turn}/>
      <mass value="{part.mass!r}"/>
      <inertia {tensor}/>
    </inertial>"""


def _draw(top: Top) -> str:
    """Return an axis, a disc and a mark on it."""
    # The drawing keeps its size whatever the body is, so that every top can be seen.
    distance = 0.6 * LENGTH * (1 if top.Mgl >= 0 else -1)
    radius = LENGTH * min(0.8, 0.5 * math.sqrt(top.Iz / top.Ix) + 0.2)
    return f"""
    {_cylinder("steel", 0.04 * LENGTH, LENGTH, LENGTH / 2)}
    {_cylinder("brass", radius, 0.12 * LENGTH, distance)}
    {_box("mark", radius, 0.122 * LENGTH, distance)}"""


def _cylinder(material: str, radius: float, length: float, height: float) -> str:
    return (
        f'<visual><origin xyz="0 0 {height:.6g}"/><geometry>'
        f'<cylinder radius="{radius:.6g}" length="{length:.6g}"/></geometry>'
        f'<material name="{material}"/></visual>'
    )


def _box(material: str, radius: float, thickness: float, height: float) -> str:
    """Return a mark on the disc that makes the spin visible."""
    return (
        f'<visual><origin xyz="{radius / 2:.6g} 0 {height:.6g}"/><geometry>'
        f'<box size="{radius:.6g} {radius / 6:.6g} {thickness:.6g}"/></geometry>'
        f'<material name="{material}"/></visual>'
    )
