"""Client of a running node: `top_ctl` and the connection that other programs use."""
