"""Runs in MCAP files, written, read and repaired; without ROS. For session and readers of logs."""
