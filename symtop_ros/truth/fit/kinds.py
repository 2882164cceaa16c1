"""Kinds of records: their columns, and the numbers of a top that each determines."""

from dataclasses import dataclass

from symtop_ros.run.simulation.points import SEEN


@dataclass(frozen=True)
class Kind:
    """A kind of record.

    Attributes
    ----------
    columns : tuple of str
        Names of the columns of a record of this kind.
    shows_spin : bool
        True if the body is seen, and not only its axis.
    shows_azimuth : bool
        True if the record shows in which direction the axis is tilted.
    residuals : tuple of str
        Names of the numbers that are compared in each row.
    rounds : float
        Period of the last column, in rad; 0: it is not periodic.
    """

    name: str
    columns: tuple[str, ...]
    shows_spin: bool = False
    shows_azimuth: bool = True
    residuals: tuple[str, ...] = ()
    rounds: float = 0.0

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)


def _kind(name: str, **more: bool | float) -> Kind:
    seen = SEEN[name]
    return Kind(name, seen.columns, residuals=seen.residuals, **more)  # type: ignore[arg-type]


#: Rates across the axis alone, of a gyroscope whose range ends below the spin.
ACROSS = Kind("across", ("wx", "wy"), True, False, ("wx", "wy"))
KINDS = {
    kind.name: kind
    for kind in (
        _kind("attitude", shows_spin=True),
        _kind("rates", shows_spin=True, shows_azimuth=False),
        _kind("inertial", shows_spin=True, shows_azimuth=False),
        ACROSS,
        _kind("axis"),
        _kind("angles", rounds=6.283185307179586),
        _kind("pixels"),
        _kind("theta", shows_azimuth=False),
    )
}
#: Names of those that tables and logs have; the others are made of them.
READ = tuple(name for name in KINDS if name in SEEN)
