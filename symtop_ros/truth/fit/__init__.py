"""`top_fit`: find the motion of a top from a record of measurements."""

from symtop_ros.truth.fit.fitting import fit_motion
from symtop_ros.truth.fit.record import Record, make_record
from symtop_ros.truth.fit.refine import Fit

__all__ = ["Fit", "Record", "fit_motion", "make_record"]
