"""Motions that are singular, or of extreme sizes, and two large errors."""

from symtop_ros.physics import State, Top

# Large errors that climbs have found, of attitude and of rates, with the time in s.
ASYMPTOTIC = (
    Top(1.0, 1.0, 50.222816944122314),
    State((0.5, 0.5, 0.5, 0.5), (5.55078125, -8.3447265625, -8.3447265625)),
    0.43182089813532337,
)
PENDULUM = (
    Top(0.014633484357533307, 0.016382813191500745, 1.1433905460050728),
    State(
        (0.4584543754896997, 0.04332316165706265, 0.19438869428189803, -0.866115306869567),
        (2.4468000659284788, 5.8403579107068255, 0.0),
    ),
    2.326967634349247,
)
TILTED = (0.7, 0.5, 0.1, -0.5)
OMEGA = (0.5, -1.25, 3.0)
UPRIGHT, HANGING = (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)
CASES = {
    "asymptotic": ASYMPTOTIC[:2],
    "pendulum": PENDULUM[:2],
    "tilted": (Top(1.0, 0.5, 2.0), State(TILTED, OMEGA)),
    "hung": (Top(1.0, 1.5, -2.0), State(TILTED, OMEGA)),
    "no weight": (Top(1.0, 0.5, 0.0), State(TILTED, OMEGA)),
    "at rest upright": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (0.0, 0.0, 0.0))),
    "sleeping": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (0.0, 0.0, 20.0))),
    "through the top": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (1.0, 0.5, 3.0))),
    "through the bottom": (Top(1.0, 0.5, 2.0), State(HANGING, (1.0, 0.5, 3.0))),
    "released": (Top(1.0, 0.5, 2.0), State(TILTED, (0.0, 0.0, 3.0))),
    "tiny": (Top(1e-100, 1e-100, 1e-100), State(TILTED, OMEGA)),
    "huge": (Top(1e100, 1e100, 1e100), State(TILTED, OMEGA)),
}
