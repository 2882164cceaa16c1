"""The bytes of our messages, as ROS 2 sends and logs them: the one place that knows them. No ROS.

The node writes them, playback reads them where there is no ROS. Byte for byte what rclpy writes.
"""
