"""Derivatives of a motion by its top and its start; imported by `Motion` alone."""
