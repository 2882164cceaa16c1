"""Drawings as arrays (the body, the ghost, the charts), and the look of figures; no viewer."""
