"""`top_live`: a running node in Rerun; needs ROS and Rerun. Panel imports its feed."""
