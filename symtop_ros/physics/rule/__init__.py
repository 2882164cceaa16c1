"""Perry's rule for a state, a kick and a map, and the verdicts; above the rest of physics."""
