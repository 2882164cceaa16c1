"""Logs read, checked, repaired and shown in Rerun. Needs no ROS, and never imports it."""
