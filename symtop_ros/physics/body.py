"""The rigid body of a top: its mass, the arm of its centre of mass, and the force on the pivot.

The motion of a top depends on Ix, Iz and Mgl only. The force of the pivot depends on the mass and
on the distance of its centre from the pivot (the arm) too, and these are not given.
`Body.from_top` chooses them, and finds a body for every top for which a rigid body exists.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from symtop_ros.base.arrays import Real
from symtop_ros.base.deprecation import OldName
from symtop_ros.base.refusals import Words, refuse, require, show_limit
from symtop_ros.physics.dynamics import DEFAULT_GRAVITY, specific_force
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import PART_KINDS
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.parts import Part
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import EPS, validate_number, validate_one, validate_positive

LONGEST_ARM = 10.0  # m, of a body that is chosen: a weight of 1e-9 J would have kilometres
FLAT = 16 * EPS  # of Ix; a bound of ten roundings of half an EPS, and those of the comparison
SAME = 1e-9  # relative difference of moments that are the same, up to the rounding of their user


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body that moves as a top does.

    A body of mass M whose centre is at a distance r from the pivot has Mgl = M g r, and about its
    centre the moments Ix - M r^2 and Iz. No principal moment of a rigid body is larger than the sum
    of the other two. So M r^2 <= Ix - Iz/2, and no arm r is longer than (Ix - Iz/2) g / |Mgl|.
    Without a given mass, `from_top` chooses half of this longest arm, but at most 10 m: the longest
    arm is that of a flat disc, and a very short one needs a very heavy body.

    Attributes
    ----------
    mass : float
        In kg. `from_top` chooses 1 kg if Mgl is zero, because Mgl then allows any mass.
    arm : float
        Position of the centre of mass on the z axis of the body, in m. It has the sign of Mgl, and
        is zero if Mgl is zero.
    Ix, Iz : float
        Transverse and axial moment of inertia about the centre of mass, in kg m^2.
    gravity : float
        Acceleration of gravity in m/s^2.

    Raises
    ------
    ValueError
        If a value is not a finite number or no rigid body has it.

    Examples
    --------
    >>> from symtop_ros.physics import Body, Top
    >>> body = Body.from_top(Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068))
    >>> round(body.mass, 4), round(body.arm, 4)
    (0.4819, 0.0144)
    >>> Body(mass=15.0, arm=1.0, Ix=0.234375, Iz=0.46875, gravity=9.81).top
    Top(Ix=15.234375, Iz=0.46875, Mgl=147.15)
    """

    mass: float
    arm: float
    Ix: float
    Iz: float
    gravity: float

    of, of_parts = OldName("from_top"), OldName("from_parts")
    disc, about_pivot = OldName("from_disc"), OldName("from_pivot_moments")

    def __post_init__(self) -> None:
        units = {"mass": "kg", "arm": "m", "Ix": "kg m^2", "Iz": "kg m^2", "gravity": "m/s^2"}
        for name, unit in units.items():
            validate = validate_number if name == "arm" else validate_positive
            object.__setattr__(self, name, validate(name, getattr(self, name), unit))
        most = 2 * self.Ix
        require(self.Iz <= most, "Iz", f"<= 2 Ix = {show_limit(most)} kg m^2", self.Iz)

    @property
    def top(self) -> Top[float]:
        """The top that moves as the body does: moments about the pivot, and Mgl.

        Raises
        ------
        ValueError
            If a moment is out of the range of a `Top`.
        """
        found = bindings.find_body_top((self.mass, self.arm, self.Ix, self.Iz), self.gravity)
        return Top(found.Ix, found.Iz, found.Mgl)

    @classmethod
    def from_pivot_moments(
        cls, mass: float, arm: float, Ix: float, Iz: float, gravity: float = DEFAULT_GRAVITY
    ) -> "Body":
        """Return the body with these moments of inertia about the pivot.

        Parameters
        ----------
        mass, arm : float
            In kg, and position of the centre of mass on the z axis in m.
        Ix, Iz : float
            Transverse and axial moment of inertia about the pivot, in kg m^2.
        gravity : float
            Acceleration of gravity in m/s^2, > 0.

        Raises
        ------
        ValueError
            If a value is refused, or if Ix is too small for this mass at this distance.

        Examples
        --------
        >>> from symtop_ros.physics import Body
        >>> Body.from_pivot_moments(mass=2.0, arm=0.5, Ix=1.5, Iz=0.25, gravity=10.0).Ix
        1.0
        """
        mass, arm = validate_number("mass", mass, "kg"), validate_number("arm", arm, "m")
        Ix, lost = validate_number("Ix", Ix, "kg m^2"), (mass * arm) * arm
        require(Ix > lost, "Ix", f"> mass arm^2 = {show_limit(lost)} kg m^2", Ix)
        return cls(mass, arm, Ix - lost, Iz, gravity)

    @classmethod
    def from_disc(
        cls, mass: float, radius: float, distance: float, gravity: float = DEFAULT_GRAVITY
    ) -> "Body":
        """Return a flat disc on a massless axle.

        Parameters
        ----------
        mass, radius : float
            In kg and m, > 0.
        distance : float
            Position of its centre on the z axis, from the pivot, in m.
        gravity : float
            Acceleration of gravity in m/s^2, > 0.

        Raises
        ------
        ValueError
            If a value is refused, or no top has these constants.

        Examples
        --------
        >>> from symtop_ros.physics import Body
        >>> Body.from_disc(mass=0.5, radius=0.25, distance=0.125, gravity=10.0).top
        Top(Ix=0.015625, Iz=0.015625, Mgl=0.625)
        """
        return cls.from_parts([Part("disc", mass, distance, radius)], gravity)

    @classmethod
    def from_parts(
        cls,
        parts: Iterable[Part],
        gravity: float = DEFAULT_GRAVITY,
        Ix: float | None = None,
        Iz: float | None = None,
    ) -> "Body":
        """Return the body that is composed of parts on a massless axle.

        Parameters
        ----------
        parts : iterable of Part
            At least one. Moments about the centre of each part are those of a thin rod, hoop or
            disc and of a solid ball; Steiner's theorem adds them.
        gravity : float
            Acceleration of gravity in m/s^2, > 0.
        Ix, Iz : float, optional
            Measured moments of inertia about the pivot in kg m^2, instead of those of the parts. A
            single point then suffices, with the mass and the arm of the body.

        Raises
        ------
        ValueError
            If a value is refused, there is no part, or the parts have no moment about the axis.

        Examples
        --------
        A disc of 1.7 kg, almost balanced by a counterweight of 0.9 kg:

        >>> from symtop_ros.physics import Body, Part
        >>> disc = Part("disc", mass=1.7, distance=0.141, size=0.128)
        >>> body = Body.from_parts([disc, Part("point", mass=0.9, distance=-0.253, spins=False)])
        >>> round(body.mass, 3), round(body.top.Mgl, 5)
        (2.6, 0.11772)
        """
        require(isinstance(parts, Iterable), "parts", "some of type Part", parts)
        given = [*parts]
        for each in given:
            require(isinstance(each, Part), "parts", "of type Part", each)
        require(given, "parts", "at least one", Words("none"))
        gravity = validate_positive("gravity", gravity, "m/s^2")
        kinds = [PART_KINDS.index(each.kind) for each in given]
        numbers = [(each.mass, each.size, each.distance) for each in given]
        found = bindings.find_body(kinds, numbers)
        if Ix is None:
            return cls(found.mass, found.arm, found.Ix, found.Iz if Iz is None else Iz, gravity)
        return cls.from_pivot_moments(
            found.mass, found.arm, Ix, found.Iz if Iz is None else Iz, gravity
        )

    @classmethod
    def from_top(
        cls, top: Top[float], gravity: float = DEFAULT_GRAVITY, mass: float | None = None
    ) -> "Body":
        """Return a body with the constants of a top, of the given mass or of a default mass.

        Parameters
        ----------
        top : Top
        gravity : float
            Acceleration of gravity in m/s^2, > 0.
        mass : float, optional
            In kg. The arm follows from it: Mgl/(mass gravity).

        Raises
        ------
        ValueError
            If gravity or mass is refused, or if no body has these constants: a flat disc (Iz = 2
            Ix) has its centre in the pivot, so gravity has no torque on it. A given mass must be at
            least Mgl^2/(gravity^2 (Ix - Iz/2)): the body with this mass is a flat disc.

        Examples
        --------
        >>> from symtop_ros.physics import Body, Top
        >>> article = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> round(Body.from_top(article, mass=0.5).arm, 6)
        0.013863
        >>> Body.from_top(article, mass=0.24)  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        symtop_ros.base.refusals.RefusedError: mass must be at least 0.24096... kg for this top, ...
        >>> Body.from_top(Top(Ix=1.0, Iz=2.0, Mgl=1.0))  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        symtop_ros.base.refusals.RefusedError: Iz must be < 2 Ix = 2 kg m^2 for a body with ...
        """
        validate_one(top)
        gravity = validate_positive("gravity", gravity, "m/s^2")
        if mass is not None:
            return _weigh(top, gravity, validate_positive("mass", mass, "kg"))
        if top.Mgl == 0:
            return cls(1.0, 0.0, top.Ix, top.Iz, gravity)
        # M r^2 <= Ix - Iz/2
        half = (top.Ix - top.Iz / 2) / 2 * (gravity / abs(top.Mgl))
        arm = math.copysign(min(half, LONGEST_ARM), top.Mgl)
        require(
            arm,
            "Iz",
            f"< 2 Ix = {show_limit(2 * top.Ix)} kg m^2 for a body with "
            f"Mgl = {top.Mgl:g} J to exist",
            top.Iz,
        )
        mass = top.Mgl / arm / gravity
        require(
            math.isfinite(arm) and 0 < mass < math.inf,
            "Mgl",
            "of a size for which the mass of a body is a double",
            top.Mgl,
        )
        # Ix - M r^2, for half of the longest arm without the subtraction
        Ix = top.Ix / 2 + top.Iz / 4 if half <= LONGEST_ARM else top.Ix - mass * arm**2
        return cls(mass, arm, Ix, top.Iz, gravity)

    def centre_of_mass(self, state: State) -> Real:
        """Return the position of the centre of mass in the world frame, (..., 3), in m."""
        return state.to_world([0.0, 0.0, self.arm])

    def pivot_force(self, motion: Motion, state: State) -> Real:
        """Return the force of the pivot on the top in the world frame.

        It is M (a + g z') with the acceleration a of the centre of mass (Newton's second law).

        Parameters
        ----------
        motion : Motion
            A motion of the body's top. Its friction and applied torque are included.
        state : State
            One state or many.

        Returns
        -------
        ndarray (..., 3)
            In N.

        Raises
        ------
        ValueError
            If the motion is that of another top.

        Examples
        --------
        The pivot carries the weight of a top that sleeps upright:

        >>> from symtop_ros.physics import Body, Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State((1, 0, 0, 0), (0, 0, 200)))
        >>> body = Body.from_top(top)
        >>> force = body.pivot_force(motion, motion.start)
        >>> force.tolist() == [0, 0, body.mass * body.gravity]
        True
        """
        validate_one(motion, "motion")
        pairs = zip(self.top.moments, motion.top.moments, strict=True)
        is_own = all(math.isclose(mine, its, rel_tol=SAME) for mine, its in pairs)
        require(is_own, "motion.top", f"{self.top}, that of the body", motion.top)
        force = specific_force(motion, state, (0.0, 0.0, self.arm), self.gravity)
        return self.mass * state.to_world(force)


def _weigh(top: Top, gravity: float, mass: float) -> Body:
    """Return the body of a given mass: M r^2 <= Ix - Iz/2, as for every rigid body."""
    lever = top.Mgl / gravity  # M r
    arm = lever / mass
    most = top.Ix - top.Iz / 2
    # A flat disc has just the least mass, and its three constants are rounded: each by some EPS of
    # itself, so that both sides differ by some EPS of Ix.
    if not lever * arm <= most + FLAT * top.Ix:
        least = lever / most * lever if most > 0 else math.inf
        condition = f"at least {show_limit(least)} kg for this top, Mgl^2/(gravity^2 (Ix - Iz/2))"
        raise refuse("mass", condition, mass)
    return Body(mass, arm, max(top.Ix - lever * arm, top.Iz / 2), top.Iz, gravity)
