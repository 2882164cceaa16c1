"""The top among ROS programs: the node, its client, and a running node in Rerun.

`node/` is the host of a session of `run/`; `client/` is `top_ctl`; `live/` draws a running node.

Nothing else needs rclpy but the bridge of `page/panel/`, and nothing but the programs
imports it. Begin with `node/top_node.py`.
"""
