"""The article retold with numbers: its top, its motions, its claims, its figures, and Perry's map.

V. Tanriverdi, "Why do we use constants of motion while studying the motion of a heavy symmetric
top?", arXiv:2103.13984. `make -C workshop article` and `make -C workshop maps` run it.
"""
