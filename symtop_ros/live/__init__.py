"""A running node in Rerun: needs ROS 2 and Rerun in one environment."""
