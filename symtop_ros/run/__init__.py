"""A run, without ROS: a motion in time, its events and its log.

`simulation/` turns a motion into samples and events, and computes the effect of each act;
`session/` adds requests, outputs and a recording; `log/` writes and reads MCAP, and finds the
missing and damaged parts of a log; `check/` computes a log again; `wire/` has the bytes of
messages; `models/` writes the top as URDF, SDF, MJCF and USD.

It imports `physics`, `words` and `base`, and knows neither ROS nor Rerun. Begin with
`simulation/simulation.py`.
"""
