"""The lowest layer: every other subpackage uses it, and it imports none of them.

`arrays.py` has types and columns of arrays, `refusals.py` the one language of refusals, `units.py`
the units that people type, `missing.py` what to install, `command.py` the options of all programs,
`shutdown.py` the signals of those with ROS.
"""
