"""The test set: its problems, and the program that computes them to 30 digits."""
