"""Bytes of the messages that symtop_ros sends and logs (CDR). Needs no ROS.

The node encodes with it, and logs are read with it on machines without ROS. The bytes are the same
as those of rclpy's serializer. For simulation and everything above.
"""
