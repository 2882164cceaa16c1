"""`top_ctl`, and the connection of other programs to a running node. Imported by panel."""
