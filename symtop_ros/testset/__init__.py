"""Seventy motions of heavy tops to 30 digits, for authors of engines; needs NumPy only."""
