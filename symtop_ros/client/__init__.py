"""top_ctl and the demonstration: clients of a running node."""
