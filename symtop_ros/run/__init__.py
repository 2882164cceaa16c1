"""A run: its stretches between two events, and the numbers of its samples. No ROS, no clock."""
