"""`top_replay`: logs in 3D with Rerun, without ROS. `ros/live` uses its viewer."""
