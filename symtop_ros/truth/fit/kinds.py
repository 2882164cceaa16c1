"""Kinds of records: what each shows of a top, and with which columns."""

from dataclasses import dataclass


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
    residuals : int
        Numbers that are compared in each row.
    rounds : float
        Period of the last column, in rad; 0: it is not periodic.
    """

    name: str
    columns: tuple[str, ...]
    shows_spin: bool = False
    shows_azimuth: bool = True
    residuals: int = 0
    rounds: float = 0.0

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)


KINDS = {
    kind.name: kind
    for kind in (
        Kind("attitude", ("w", "x", "y", "z"), shows_spin=True, residuals=3),
        Kind("rates", ("wx", "wy", "wz"), shows_spin=True, shows_azimuth=False, residuals=3),
        Kind(
            "inertial",
            ("wx", "wy", "wz", "fx", "fy", "fz"),
            shows_spin=True,
            shows_azimuth=False,
            residuals=6,
        ),
        Kind("axis", ("x", "y", "z"), residuals=3),
        Kind("angles", ("theta", "phi"), residuals=2, rounds=6.283185307179586),
        Kind("pixels", ("u", "v"), residuals=2),
        Kind("theta", ("theta",), shows_azimuth=False, residuals=1),
    )
}
