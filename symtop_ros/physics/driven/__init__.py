"""Motion with friction or an applied torque, as Taylor series. Imported by `Motion` alone."""
