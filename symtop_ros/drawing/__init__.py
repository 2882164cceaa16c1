"""Drawings as arrays: the body, the ghost and the charts. Needs no viewer."""
