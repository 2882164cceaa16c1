"""The node `top`: parameters, services, publishers and pacing around a simulation."""
