"""The ROS 2 node: topics, services, parameters and scenes around a motion."""
