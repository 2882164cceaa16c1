"""Motions to any number of digits in mpmath, from two sources that share no formula.

What they give is measured, not proved: so many digits as two precisions, or both, agree in. Tests
and the report compare with it, and with the balls of `symtop_ros.physics.reference`.
"""

from workshop.digits.closed_form import ClosedForm
from workshop.digits.series import Series
from workshop.digits.state import ExactState

__all__ = ["ClosedForm", "ExactState", "Series"]
