"""The heavy symmetric top: closed-form physics and a ROS 2 node."""

__version__ = "0.7.0.dev0"
