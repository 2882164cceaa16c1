"""Scores of the releases of engines in the test set: which release changed what."""
