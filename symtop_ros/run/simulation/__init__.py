"""A run of the top without ROS: scenes, settings, requests, events and the samples of each topic.

Clock and sink are handed in: the node passes those of ROS, tests pass simple ones. Everything above
physics and wire may import it.
"""
