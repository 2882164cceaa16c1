"""Names in the recording."""

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
PANEL = "/motion"
EVENTS = "/events"
THETA = "/plots/theta"
PHI_DOT = "/plots/phi_dot"
PSI_DOT = "/plots/psi_dot"
L = "/plots/L"
L_HORIZONTAL = "/plots/L_horizontal"
DRIFT = "/plots/drift"
PLOTS = {  # and their titles
    THETA: "tilt theta (rad)",
    PHI_DOT: "precession phi' (rad/s)",
    PSI_DOT: "spin psi' (rad/s)",
    L: "angular momentum L (N m s)",
    L_HORIZONTAL: "L\u00b2 - L_z'\u00b2 (N\u00b2 m\u00b2 s\u00b2)",
    DRIFT: "relative drift of E, L_z, L_z' (eps)",
}
