"""The heavy symmetric top: closed-form physics and a ROS 2 node."""

from symtop_ros.base.moved import accept_old_names

__version__ = "0.5.0"

accept_old_names()
