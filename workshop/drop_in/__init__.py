"""The kernel as two files for another tree: what goes with them, and the program that joins it."""
