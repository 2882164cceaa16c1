"""`top_replay`: logs in 3D with Rerun, without ROS. Imported by live."""
