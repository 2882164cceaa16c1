"""The experiments behind numerical choices, small enough to read and to run; nothing imports them.

`python -m design.NAME` prints what an experiment shows. The comment at the choice names it.
"""
