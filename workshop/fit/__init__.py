"""Trials of `top_fit`: synthetic records of random tops, and what one does without it."""
