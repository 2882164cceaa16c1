"""Logs of runs in MCAP files: write, read, check and repair. Needs no ROS and no Rerun."""
