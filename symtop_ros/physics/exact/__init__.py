"""Exact motion under gravity, and numbers of 50 digits. Imported inside physics only."""
