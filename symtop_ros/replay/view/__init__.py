"""The 3D scene in Rerun: entities, geometry, plots, layout. For playback and live."""
