"""Exact motions for testing engines, filters and measurements.

`judge/` compares estimates with the exact motion and names causes; `testset/` has seventy motions
to 30 digits, writes them for engines, and scores; `imu/` makes records of an inertial sensor;
`fit/` finds the motion from a measurement. They stand on `tables/` (rows of text), `topics/`
(messages) and `residuals/` (noise, and the deviations that follow), which know none of them.

An author of an engine or a filter needs no other package than this one and `physics`. Begin with
`judge/main.py` or `testset/main.py`.
"""
