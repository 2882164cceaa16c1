"""The 3D scene and its plots in Rerun: entities, geometry and layout."""
