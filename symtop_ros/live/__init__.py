"""A running node in Rerun. Needs ROS 2 and Rerun in one environment."""
