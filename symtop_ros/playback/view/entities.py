"""Paths of the entities in a recording, and their colours."""

# Colours on the dark background
BLUE = (88, 132, 249)
GREEN = (120, 240, 164)
RED = (225, 61, 101)
GOLD = (251, 213, 98)
ORANGE = (192, 103, 34)
VIOLET = (195, 122, 194)
SKY = (120, 190, 250)
GREY = (70, 78, 92)
WHITE = (240, 244, 250)
BACKGROUND = (22, 26, 34)
PALE_GREEN, PALE_BLUE = (60, 140, 95), (60, 105, 170)  # of cones, with their full colours
ASH = (118, 126, 140)  # of what was before
# Of bodies
STEEL = (196, 202, 210)
BRASS = (222, 178, 92)
ENAMEL = (150, 32, 44)
IVORY = (240, 230, 205)
STONE = (92, 98, 110)

TIMELINE = "time"  # s since the first sample
SPACE = "/space"
BODY = "/space/top"
STAND = "/space/stand"
SPHERE = "/space/sphere"
TRACE = "/space/trace"
NODES = "/space/line_of_nodes"
CIRCLES = "/space/turning_circles"
MOMENTUM = "/space/angular_momentum"
VELOCITY = "/space/angular_velocity"
TORQUE = "/space/torque"
SPECIFIC_FORCE = "/space/specific_force"
ANGLES = "/space/angles"
INERTIAL = "/space/inertial_torque"
FICTITIOUS = "/space/fictitious_torque"
POLHODE = "/space/top/polhode"  # in the body frame
HERPOLHODE = "/space/herpolhode"
GHOST = "/space/ghost"
GHOST_TRACE = "/space/ghost_trace"
PANEL = "/motion"
SENTENCE = "/sentence"  # the verdict of the last event
POTENTIAL = "/potential"
CUBIC = "/cubic"
EVENTS = "/events"
THETA = "/plots/theta"
PHI_DOT = "/plots/phi_dot"
PSI_DOT = "/plots/psi_dot"
L = "/plots/L"
L_HORIZONTAL = "/plots/L_horizontal"
DRIFT = "/plots/drift"
ENERGY = "/plots/energy"
NODES_TORQUE = "/plots/torque_along_nodes"
# Titles of the plots
PLOTS = {
    THETA: "tilt theta (rad)",
    PHI_DOT: "precession phi' (rad/s)",
    PSI_DOT: "spin psi' (rad/s)",
    L: "angular momentum L (N m s)",
    L_HORIZONTAL: "L\u00b2 - L_z'\u00b2 (N\u00b2 m\u00b2 s\u00b2)",
    ENERGY: "energy, stacked (J)",
    NODES_TORQUE: "torques along the line of nodes (N m)",
    DRIFT: "relative drift of E, L_z, L_z' (eps)",
}


def lighten(color: tuple[int, ...]) -> tuple[int, int, int]:
    """Return the colour of a label, halfway to white.

    Labels stand on grey in the light theme of the viewer, where the full colours are hard to read.
    """
    red, green, blue = color[:3]
    return (red + 255) // 2, (green + 255) // 2, (blue + 255) // 2
