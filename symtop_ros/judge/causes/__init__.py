"""Causes of errors of estimates: conventions, rotations, delays, drifts, clocks. For judge."""
