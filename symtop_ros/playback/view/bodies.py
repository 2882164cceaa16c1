"""Meshes as archetypes of Rerun."""

from __future__ import annotations

import rerun as rr

from symtop_ros.drawing.mesh import Mesh


def to_mesh3d(mesh: Mesh, opacity: int | None = None) -> rr.Mesh3D:
    """Return a mesh as an archetype; it is translucent if an opacity (of 255) is given."""
    return rr.Mesh3D(
        vertex_positions=mesh.positions,
        vertex_normals=mesh.normals,
        vertex_colors=mesh.colors,
        triangle_indices=mesh.triangles,
        albedo_factor=None if opacity is None else [255, 255, 255, opacity],
    )
