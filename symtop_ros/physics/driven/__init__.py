"""The motion with friction or an applied torque, as Taylor series in time."""
