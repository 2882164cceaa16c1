"""What explains the errors of estimates: conventions, rotations, delays, drifts and clocks."""
