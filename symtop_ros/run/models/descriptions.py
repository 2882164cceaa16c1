"""Equivalent descriptions of one body: its frame turned or moved, its mass in a fixed child.

A turned frame has a full tensor of inertia, or three moments along the axes of an inertial frame.

There is one motion for all of them, and each number is rounded once from the exact one. An engine
that handles such frames or children wrongly shows different motions.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from symtop_ros.base.arrays import Vector, multiply
from symtop_ros.physics import Body, State, Top

STEP = 1e-4  # s, of all models; at 200 rad/s a step of 0.02 rad
Exact = tuple[Fraction, ...]
# The rotation of a turned frame to the principal axes: its quaternion w, x, y, z, its matrix, whose
# last row is the symmetry axis in the turned frame, and its angles about the fixed axes x, y, z:
# arctan(4/3), arcsin(3/5) and pi/2.
TURN: Exact = tuple(map(Fraction, ("0.7", "0.1", "0.5", "0.5")))
MATRIX: tuple[Exact, ...] = tuple(
    tuple(Fraction(each, 25) for each in row) for row in ((0, -15, 20), (20, 12, 9), (-15, 16, 12))
)
ROLL_PITCH_YAW: Vector = (0.9272952180016122, 0.6435011087932844, 1.5707963267948966)
# The same for the inertial frame: from the principal axes to the turned frame.
BACK: tuple[float, ...] = (float(TURN[0]), *(-float(each) for each in TURN[1:]))
ROLL_PITCH_YAW_BACK: Vector = (0.6435011087932844, -0.9272952180016122, -1.5707963267948966)
UPRIGHT: Exact = tuple(map(Fraction, (0, 0, 1)))
ORIGIN: Vector = (0.0, 0.0, 0.0)
# Origin of a moved frame, in units of the size of the body. It has no symmetry, and few digits.
SHIFT = (0.25, -0.375, 0.5)


class Inertial(NamedTuple):
    """Mass, centre of mass in the frame, and moments about it along the axes of the frame.

    The axes may be those of an inertial frame, which is turned back to the principal ones.
    """

    mass: float  # kg
    centre: Vector  # m
    moments: Vector  # xx, yy, zz in kg m^2
    products: Vector  # xy, xz, yz in kg m^2
    is_principal: bool = False  # the axes are those of an inertial frame

    @property
    def tensor(self) -> dict[str, float]:
        """Moments and products by the names that URDF and SDF give them."""
        names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        return dict(zip(names, (*self.moments, *self.products), strict=True))


@dataclass(frozen=True)
class Description:
    """A description of a body: by the frame of its link, and by the part in a fixed child.

    The frame of the child is turned and moved as well.
    """

    turned: bool = False  # False: the frame of the link is along the principal axes
    pivot: Vector = ORIGIN  # the fixed point in the frame of the link, m
    share: float = 1.0  # of the mass in the link; the rest is in the child
    child: Vector = ORIGIN  # the fixed point in the frame of the child, m
    is_principal: bool = False  # the link, which is turned, has an inertial frame

    @property
    def has_child(self) -> bool:
        """True if a part of the mass is in a child."""
        return self.share < 1

    @property
    def is_moved(self) -> bool:
        """True if the origin of the link is not in the pivot."""
        return any(self.pivot)

    @property
    def axis(self) -> Vector:
        """The symmetry axis in the frame of the link."""
        return _round(MATRIX[2] if self.turned else UPRIGHT)

    def link(self, body: Body) -> Inertial:
        """Return what the link has of the body."""
        part = _express(body, self.share, self.turned, self.pivot)
        if not self.is_principal:
            return part
        moments = body.Ix, body.Ix, body.Iz
        return part._replace(moments=moments, products=ORIGIN, is_principal=True)

    def part(self, body: Body) -> Inertial:
        """Return what the child has of the body."""
        return _express(body, 1 - self.share, True, self.child)

    def place_child(self) -> Vector:
        """Return the origin of the child in the frame of the link, whose origin is the pivot."""
        return _round(-_dot(row, map(Fraction, self.child)) for row in MATRIX)

    def begin(self, start: State) -> State:
        """Return the start of a motion, as the frame of the link has it."""
        if not self.turned:
            return start
        q = multiply(map(Fraction, start.orientation.tolist()), TURN)
        omega = [Fraction(each) for each in start.angular_velocity.tolist()]
        turned = _round(_dot(column, omega) for column in zip(*MATRIX, strict=True))
        return State([*map(float, q)], turned)

    def find_origin(self, start: State) -> tuple[Vector, Vector]:
        """Return place and velocity of the origin of the link in the world, with the pivot at 0."""
        state = self.begin(start)
        a, b, c = (-each for each in self.pivot)
        x, y, z = state.angular_velocity.tolist()
        turning = y * c - z * b, z * a - x * c, x * b - y * a
        return _round(state.to_world((a, b, c))), _round(state.to_world(turning))


PLAIN = Description()


def describe(name: str, body: Body) -> Description:
    """Return a description of a body by its name, as the test set has it."""
    size = float(f"{measure_size(body):.1g}")
    x, y, z = (each * size for each in SHIFT)
    return {
        "turned": Description(turned=True),
        "inertial": Description(turned=True, is_principal=True),
        "offset": Description(pivot=(x, y, z)),
        "nested_half": Description(share=0.5, child=(x, y, z)),
        "nested": Description(share=0.0, child=(x, y, z)),
    }[name]


def measure_size(body: Body) -> float:
    """Return the length of the drawn axis in m: beyond the centre of mass, and near the body."""
    return max(abs(body.arm) / 0.6, 2 * math.sqrt(body.Ix / body.mass))


def _express(body: Body, share: float, turned: bool, pivot: Vector) -> Inertial:
    """Return a part of a body in a frame in which the fixed point has a given place."""
    axis = MATRIX[2] if turned else UPRIGHT
    across, along = (Fraction(each) * Fraction(share) for each in (body.Ix, body.Iz))
    centre = [Fraction(p) + Fraction(body.arm) * u for p, u in zip(pivot, axis, strict=True)]
    x, y, z = axis
    products = ((along - across) * each for each in (x * y, x * z, y * z))
    moments = (across + (along - across) * each * each for each in axis)
    return Inertial(body.mass * share, _round(centre), _round(moments), _round(products))


def describe_body(top: Top, body: Body) -> str:
    """Return the sentence that says which body stands for a top."""
    return (
        f"Ix = {top.Ix!r} kg m^2 and Iz = {top.Iz!r} kg m^2 about the pivot, Mgl = {top.Mgl!r} J "
        f"with g = {body.gravity!r} m/s^2. These fix the product of mass and arm only. Here: "
        f"{body.mass:.6g} kg, {body.arm:.6g} m along z."
    )


def join(numbers: Iterable[float], between: str = " ") -> str:
    """Return numbers in full, with spaces or another text between them."""
    return between.join(map(repr, numbers))


def _dot(row: Exact, vector: Iterable[Fraction]) -> Fraction:
    return sum((a * b for a, b in zip(row, vector, strict=True)), Fraction())


def _round(numbers: Iterable[Fraction]) -> Vector:
    x, y, z = map(float, numbers)
    return x, y, z
