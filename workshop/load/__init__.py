"""Load on a real node: stress, soak, cost; and the processes, clients and listeners for it."""
