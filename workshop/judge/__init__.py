"""Trials of `top_judge`: files of a generator that shares no formula with it, and what it says."""
