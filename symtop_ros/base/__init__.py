"""The ground floor: what every room uses, and what imports no room.

`arrays.py` has types and columns of arrays, `refusals.py` the one language of refusals, `units.py`
the units that people type, `missing.py` what to install, `command.py` the options of all programs,
`shutdown.py` the signals of those with ROS.
"""
