"""A top and its start as URDF, SDF and MJCF, the files that other engines read.

All of them hold a body that moves as the top does, with its doubles in full, in any of its
descriptions. Friction and applied torques are left out: no format has friction that differs along
and across the axis.

A top without weight turns about its centre of mass, and the pivot does nothing. Engines have code
of their own for free bodies, which a ball joint does not reach: such a body has models that nothing
holds, too.
"""

from typing import Protocol

from symtop_ros.models.descriptions import PLAIN, Description, join
from symtop_ros.models.mjcf import format_free_mjcf, format_mjcf
from symtop_ros.models.sdf import format_free_sdf, format_sdf
from symtop_ros.models.urdf import describe_inertial, join_child, robot_description
from symtop_ros.physics import Body, State, Top


class Format(Protocol):
    """Writes a model file."""

    def __call__(self, top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
        """Return the text of a description of a body."""


def format_urdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as URDF: three revolute joints, since the format has no ball joint."""
    angles, rates = start.euler_angles, start.euler_rates
    text = robot_description(top, "world", "top", tf_moves_it=False, body=body, described=described)
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


def format_free_urdf(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as URDF with one link, and its child; its start is in a comment."""
    state = described.begin(start)
    w, x, y, z = state.orientation.tolist()
    rest = "at rest in the origin"
    if described.is_moved:
        place, velocity = map(join, described.find_origin(start))
        rest = f"place {place} m and velocity {velocity} m/s of the frame (world),\n    "
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


FORMATS: dict[str, Format] = {"urdf": format_urdf, "sdf": format_sdf, "mjcf": format_mjcf}
FREE_FORMATS: dict[str, Format] = {
    "free.urdf": format_free_urdf,
    "free.sdf": format_free_sdf,
    "free.mjcf": format_free_mjcf,
}
# What a format cannot say: the axis of a URDF's joint goes through the origin of its link, and a
# link of SDF has mass.
UNSAID = {("offset", "urdf"), ("nested", "sdf"), ("nested", "free.sdf")}
