"""Weight and spin of a top, from twenty tilts that a camera has seen: a particle filter."""

import numpy as np

from symtop_ros.physics import Motion, Motions, State, Top

rng = np.random.default_rng(7)
times = np.arange(1, 21) / 10
truth = Motion(Top(0.000228, 0.0000572, 0.068), State.from_euler(theta=0.5, psi_dot=200.0))
seen = truth.at(times).euler_angles.theta + 0.01 * rng.normal(size=times.size)

count = 5000
weight, spin = rng.uniform(0.05, 0.09, count), rng.uniform(150.0, 250.0, count)
guesses = Motions(Top(0.000228, 0.0000572, weight), State.from_euler(theta=0.5, psi_dot=spin))
theta = guesses.at(times).euler_angles.theta
chi_squared = (((theta - seen) / 0.01) ** 2).sum(axis=1)
likelihood = np.exp(-0.5 * (chi_squared - chi_squared.min()))
likelihood /= likelihood.sum()
print(f"Mgl = {likelihood @ weight:.4f} J, spin = {likelihood @ spin:.1f} rad/s")
