"""Speed against error: the package's engines compared with the integrators that are installed."""
