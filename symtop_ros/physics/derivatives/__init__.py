"""Derivatives of a motion by its top and its start. Imported by `Motion` alone."""
