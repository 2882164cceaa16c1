"""Parts of a body on the axis of a top: points, rods, hoops, discs and balls."""

from dataclasses import dataclass

from symtop_ros.base.refusals import choice, flag, require
from symtop_ros.physics.kernel.records import PART_KINDS, PartKind
from symtop_ros.physics.values import validate_number, validate_positive

# Meaning of the size of each kind; a point has no size.
SIZES = {"rod": "length", "hoop": "radius", "disc": "radius", "ball": "radius"}
WITHOUT_SPIN = ("point", "rod")  # which have no moment about the axle


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a body, with its centre on the axis.

    Attributes
    ----------
    kind : str
        "point"; "rod", thin and along the axis; "hoop" or "disc", thin and across it; or "ball".
    mass : float
        In kg, > 0.
    distance : float
        Position of its centre on the z axis of the body, from the pivot, in m; negative on the
        other side of the pivot.
    size : float
        Length of a rod, or radius of a hoop, disc or ball, in m, > 0. A point has no size.
    spins : bool
        True if the part turns about the axle with the body. A part that does not, such as a
        counterweight, must have no moment about the axle: a point or a rod. Any other part, held by
        the fork, would add I phi'^2 cos(theta)^2/2 to the energy, a term that the energy of a top
        does not have.

    Raises
    ------
    ValueError
        If a value is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Part
    >>> Part("disc", mass=1.7, distance=0.141, size=0.128).kind
    'disc'
    >>> Part("ball", mass=0.9, distance=-0.253, size=0.05, spins=False)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    symtop_ros.base.refusals.RefusedError: spins must be true for a ball, which has a moment ...
    """

    kind: PartKind
    mass: float
    distance: float
    size: float = 0.0
    spins: bool = True

    def __post_init__(self) -> None:
        choice("kind", self.kind, PART_KINDS)
        object.__setattr__(self, "mass", validate_positive("mass", self.mass, "kg"))
        object.__setattr__(self, "distance", validate_number("distance", self.distance, "m"))
        if name := SIZES.get(self.kind):
            object.__setattr__(self, "size", validate_positive(name, self.size, "m"))
        else:
            require(self.size == 0, "size", "0 m for a point", self.size)
        flag("spins", self.spins)
        condition = f"true for a {self.kind}, which has a moment about the axle"
        require(self.spins or self.kind in WITHOUT_SPIN, "spins", condition, self.spins)


# The bodies of a class, as it can weigh and measure them.
BODIES: dict[str, tuple[Part, ...]] = {
    "disc_on_axle": (Part("disc", mass=0.17, distance=0.105, size=0.055),),
    "hoop": (Part("hoop", mass=3.0, distance=0.6, size=0.4),),
    "bicycle_wheel": (Part("hoop", mass=5.5, distance=0.17, size=0.591),),
    "balanced_gyroscope": (
        Part("disc", mass=1.7, distance=0.141, size=0.127),
        Part("point", mass=0.9, distance=-0.253, spins=False),
    ),
}
