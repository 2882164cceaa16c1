"""Attitudes and rates in messages of a log."""
