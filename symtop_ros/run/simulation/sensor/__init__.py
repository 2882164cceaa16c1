"""The sensor on the top: exact, or with noise that is computed again. For all above."""
