"""A body as a stage of USD with its physics (UsdPhysics), held by a spherical joint, or by nothing.

The schema has single precision for all that moves, and a body's mass is more than zero, so that the
whole of it cannot be in a child. It defines velocities in the space of a body's transform. Some
readers take the space of the parent, others that of the body. Here both are the same, because the
parent has the pose of the start, and the body has no transform. Rates are in degrees per second,
and a linear velocity is that of the centre of mass.
"""

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from symtop_ros.base.arrays import Vector, multiply
from symtop_ros.physics import Body, State, Top
from symtop_ros.run.models.descriptions import (
    BACK,
    ORIGIN,
    PLAIN,
    TURN,
    Description,
    Inertial,
    describe_body,
    join,
    measure_size,
)

ALONG = (1.0, 0.0, 0.0, 0.0)
SCHEMAS = '(prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])'


class Frame(NamedTuple):
    """The frame of a body at the start, in the world."""

    state: State
    place: Iterable[float]  # of its origin, m
    pivot: Vector  # in the frame, m


def format_usd(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the top as a stage of USD with a spherical joint in the pivot."""
    joint = f"""
    def PhysicsSphericalJoint "pivot"
    {{
        rel physics:body1 = </World/start_top/top>
        point3f physics:localPos0 = (0, 0, 0)
        quatf physics:localRot0 = {_write(ALONG)}
        point3f physics:localPos1 = {_write(described.pivot)}
        quatf physics:localRot1 = {_write(ALONG)}
    }}
"""
    return _write_stage(top, body, body.gravity, _list_bodies(start, body, described), joint)


def format_free_usd(top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
    """Return the body as a stage of USD without a joint."""
    return _write_stage(top, body, 0.0, _list_bodies(start, body, described), "")


def _write_stage(top: Top, body: Body, gravity: float, bodies: str, joint: str) -> str:
    return f"""#usda 1.0
(
    defaultPrim = "World"
    doc = "{describe_body(top, body)}"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = "Z"
)

def Xform "World"
{{
    def PhysicsScene "scene"
    {{
        vector3f physics:gravityDirection = (0, 0, -1)
        float physics:gravityMagnitude = {gravity!r}
    }}
{bodies}{joint}}}
"""


def _list_bodies(start: State, body: Body, described: Description) -> str:
    """Return the link, and what is in a fixed child, as bodies of the world."""
    frame = Frame(described.begin(start), described.find_origin(start)[0], described.pivot)
    axes = BACK if described.turned else ALONG
    drawn = _draw(body) if described == PLAIN else ""
    moments = _scale(body, described.share)
    text = _write_body("top", described.link(body), frame, moments, axes, drawn)
    return text + (_write_child(frame, body, described) if described.has_child else "")


def _write_child(link: Frame, body: Body, described: Description) -> str:
    """Return the child and the joint that holds it; the origin of the link is the pivot."""
    place = described.place_child()
    turned = multiply(map(Fraction, link.state.orientation.tolist()), TURN)
    rates = State(BACK, ORIGIN).to_world(link.state.angular_velocity)
    state = State([*map(float, turned)], rates)
    frame = Frame(state, link.state.to_world(place).tolist(), described.child)
    moments = _scale(body, 1 - described.share)
    text = _write_body("part", described.part(body), frame, moments, BACK, "")
    return f"""{text}
    def PhysicsFixedJoint "fixed"
    {{
        rel physics:body0 = </World/start_top/top>
        rel physics:body1 = </World/start_part/part>
        point3f physics:localPos0 = {_write(place)}
        quatf physics:localRot0 = {_write(map(float, TURN))}
        point3f physics:localPos1 = (0, 0, 0)
        quatf physics:localRot1 = {_write(ALONG)}
    }}
"""


def _scale(body: Body, share: float) -> Vector:
    """Return the principal moments of a part of the body about its centre of mass."""
    across, along = (float(Fraction(each) * Fraction(share)) for each in (body.Ix, body.Iz))
    return across, across, along


def _write_body(
    name: str, inertial: Inertial, frame: Frame, moments: Vector, axes: Iterable[float], drawn: str
) -> str:
    """Return a rigid body, with the quaternion from its principal axes to its frame."""
    a, b, c = (x - y for x, y in zip(inertial.centre, frame.pivot, strict=True))
    x, y, z = rates = frame.state.angular_velocity.tolist()
    velocity = y * c - z * b, z * a - x * c, x * b - y * a
    return f"""
    def Xform "start_{name}"
    {{
        double3 xformOp:translate = {_write(frame.place)}
        quatd xformOp:orient = {_write(frame.state.orientation.tolist())}
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]

        def Xform "{name}" {SCHEMAS}
        {{
            float physics:mass = {inertial.mass!r}
            point3f physics:centerOfMass = {_write(inertial.centre)}
            float3 physics:diagonalInertia = {_write(moments)}
            quatf physics:principalAxes = {_write(axes)}
            vector3f physics:velocity = {_write(velocity)}
            vector3f physics:angularVelocity = {_write(map(math.degrees, rates))}
{drawn}        }}
    }}
"""


def _draw(body: Body) -> str:
    size = measure_size(body)
    middle = (*ORIGIN[:2], math.copysign(size / 2, body.arm))
    shapes = (
        ("axis", middle, 0.04 * size, size),
        ("disc", (*ORIGIN[:2], body.arm), 0.4 * size, 0.1 * size),
    )
    return "".join(
        f"""
            def Cylinder "{name}"
            {{
                double3 xformOp:translate = {_write(place)}
                uniform token[] xformOpOrder = ["xformOp:translate"]
                double radius = {radius!r}
                double height = {height!r}
                uniform token axis = "Z"
            }}
"""
        for name, place, radius, height in shapes
    )


def _write(numbers: Iterable[float]) -> str:
    return f"({join(numbers, ', ')})"
