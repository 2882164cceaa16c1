"""Logs played back in 3D with Rerun. Needs no ROS."""
