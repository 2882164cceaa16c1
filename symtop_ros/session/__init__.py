"""A run with its requests, its outputs, its log and its diagnostics; needs no ROS."""
