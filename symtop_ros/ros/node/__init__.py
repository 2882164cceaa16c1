"""`top_node`: parameters, services, publishers and pacing of a session. Nothing imports it."""
