"""The top and its start as URDF, SDF, MJCF and USD. Imported by session, node, check and testset.

All of them hold a body that moves as the top does, with its doubles in full, in any of its
descriptions. Friction and applied torques are left out: no format has friction that differs along
and across the axis.

A top without weight turns about its centre of mass, and the pivot does nothing. Engines have code
for free bodies, which a ball joint does not reach: such a body has models that nothing
holds, too.
"""

from typing import Protocol

from symtop_ros.physics import Body, State, Top
from symtop_ros.run.models.descriptions import PLAIN, Description
from symtop_ros.run.models.engines import format_free_mjcf, format_free_sdf, format_mjcf, format_sdf
from symtop_ros.run.models.urdf import format_free_urdf, format_urdf
from symtop_ros.run.models.usd import format_free_usd, format_usd


class Format(Protocol):
    """Writes a model file."""

    def __call__(self, top: Top, start: State, body: Body, described: Description = PLAIN) -> str:
        """Return the text of a description of a body."""


FORMATS: dict[str, Format] = {
    "urdf": format_urdf,
    "sdf": format_sdf,
    "mjcf": format_mjcf,
    "usd": format_usd,
}
FREE_FORMATS: dict[str, Format] = {
    "free.urdf": format_free_urdf,
    "free.sdf": format_free_sdf,
    "free.mjcf": format_free_mjcf,
    "free.usd": format_free_usd,
}
# Descriptions that a format cannot express: the axis of a URDF joint goes through the origin of its
# link, and a link of SDF and a body of USD must have mass. USD describes a turned body only as in
# "turned", by principal axes and moments.
UNSAID = {("offset", "urdf"), ("inertial", "usd"), ("inertial", "free.usd")}
UNSAID |= {("nested", form) for form in ("sdf", "free.sdf", "usd", "free.usd")}


def name_file(name: str, form: str) -> str:
    """Return the name of the file of a model; a stage of USD as text ends in usda."""
    return f"{name}.{form}{'a' if form.endswith('usd') else ''}"
