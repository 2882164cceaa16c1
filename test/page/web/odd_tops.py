"""Starts over 300 decades, as addresses of the page."""

import math

SPANS = 3, 30, 100, 150  # decades above and below 1
MOST = 99  # decades of a rate


def draw_start(rng):
    """Return the names and values of a random start; one in ten is refused."""
    span = rng.choice(SPANS)

    def draw_size(decades):
        return 10 ** rng.uniform(-decades, decades)

    def draw_signed(decades):
        return rng.choice((0, 1, -1)) * draw_size(decades)

    rates = {name: draw_signed(min(span, MOST)) for name in ("theta_dot", "phi_dot", "psi_dot")}
    Ix = draw_size(span)
    values = {
        "Ix": Ix,
        "Iz": Ix * (rng.uniform(0.001, 2) if rng.random() < 0.9 else 10 ** rng.uniform(-20, 0)),
        "Mgl": draw_signed(span),
        "theta": rng.choice((0, math.pi, 0.5, rng.uniform(0, math.pi), 10 ** rng.uniform(-100, 0))),
        **rates,
    }
    optional = {"axial": draw_size(span), "transverse": draw_size(span)}
    optional["precession"] = rng.choice(("fast", "slow"))
    chosen = {name: value for name, value in optional.items() if rng.random() < 0.3}
    if "precession" in chosen:  # which has these rates
        del values["theta_dot"], values["phi_dot"]
    return values | chosen


def write_address(values):
    return "#" + "&".join(f"{name}={value}" for name, value in values.items())
