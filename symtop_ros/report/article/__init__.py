"""The article retold with numbers: its top, its motions, its claims and its figures.

V. Tanriverdi, "Why do we use constants of motion while studying the motion of a heavy symmetric
top?", arXiv:2103.13984.
"""
