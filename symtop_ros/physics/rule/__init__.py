"""Perry's rule for a state, a kick and a map, and the verdicts. Above the rest of physics."""
