"""A run with requests, outputs, log and diagnostics; without ROS. For its hosts, and check."""
