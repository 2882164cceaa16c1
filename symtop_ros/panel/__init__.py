"""`top_panel`: a page in the browser to play with a top. Needs no ROS, and viser."""
