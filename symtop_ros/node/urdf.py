"""The URDF of the top: three joints z-x-z, and a body with its moments of inertia.

Joint names are those of ~/euler_angles, so that robot_state_publisher moves it; the link of the
body is the frame that /tf moves, so that rviz and Rerun show it without one.
"""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

from symtop_ros.physics import Top

LENGTH = 0.1  # m, from the pivot to the upper end: only a drawing, Mgl does not tell size from mass
GRAVITY = 9.81
QUOTES = {'"': "&quot;"}


def robot_description(top: Top, world_frame: str, top_frame: str) -> str:
    """Return the URDF of a top."""
    world_frame, top_frame = (escape(name, QUOTES) for name in (world_frame, top_frame))
    distance = 0.6 * LENGTH * (1 if top.Mgl >= 0 else -1)
    mass = abs(top.Mgl) / (GRAVITY * abs(distance))
    # Ix is about the pivot (Steiner); a drawing whose mass does not fit keeps Ix >= Iz/2
    Ix = max(top.Ix - mass * distance**2, top.Iz / 2)
    radius = LENGTH * min(0.8, 0.5 * math.sqrt(top.Iz / top.Ix) + 0.2)
    return f"""<?xml version="1.0"?>
<robot name="symtop">
  <material name="steel"><color rgba="0.55 0.6 0.66 1"/></material>
  <material name="brass"><color rgba="0.85 0.65 0.25 1"/></material>
  <material name="mark"><color rgba="0.75 0.15 0.1 1"/></material>
  <link name="{world_frame}"/>
  <link name="{top_frame}_precession"/>
  <link name="{top_frame}_tilt"/>
  <joint name="precession" type="continuous">
    <parent link="{world_frame}"/><child link="{top_frame}_precession"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="tilt" type="continuous">
    <parent link="{top_frame}_precession"/><child link="{top_frame}_tilt"/><axis xyz="1 0 0"/>
  </joint>
  <joint name="spin" type="continuous">
    <parent link="{top_frame}_tilt"/><child link="{top_frame}"/><axis xyz="0 0 1"/>
  </joint>
  <link name="{top_frame}">
    <inertial>
      <origin xyz="0 0 {distance}"/>
      <mass value="{mass!r}"/>
      <inertia ixx="{Ix!r}" iyy="{Ix!r}" izz="{top.Iz!r}" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    {_cylinder("steel", 0.04 * LENGTH, LENGTH, LENGTH / 2)}
    {_cylinder("brass", radius, 0.12 * LENGTH, distance)}
    {_box("mark", radius, 0.122 * LENGTH, distance)}
  </link>
</robot>
"""


def _cylinder(material: str, radius: float, length: float, height: float) -> str:
    return (
        f'<visual><origin xyz="0 0 {height:.6g}"/><geometry>'
        f'<cylinder radius="{radius:.6g}" length="{length:.6g}"/></geometry>'
        f'<material name="{material}"/></visual>'
    )


def _box(material: str, radius: float, thickness: float, height: float) -> str:
    """A mark on the disc, by which the spin can be seen."""
    return (
        f'<visual><origin xyz="{radius / 2:.6g} 0 {height:.6g}"/><geometry>'
        f'<box size="{radius:.6g} {radius / 6:.6g} {thickness:.6g}"/></geometry>'
        f'<material name="{material}"/></visual>'
    )
