"""The torque that samples of ~/applied_torque ask for."""

from __future__ import annotations

from geometry_msgs.msg import WrenchStamped

from symtop_ros.node.fields import numbers, refuse

LARGEST = 1e30  # N m, as for Mgl
Three = tuple[float, float, float]
NONE: Three = (0.0, 0.0, 0.0)


class AppliedTorque:
    """The torque of the last sample, until it has run out.

    Parameters
    ----------
    frame : str
        World frame, in which it is given.
    """

    def __init__(self, frame: str) -> None:
        self._frame = frame
        self.value = NONE
        self.end = 0  # stamp in ns from which it acts no more

    def hold(self, message: WrenchStamped, stamp: int, timeout: float) -> None:
        """Take a sample that acts from a stamp (ns) on for a time-out (s).

        Raises
        ------
        RefusedError
            Where a number is not finite, or the frame is another one.
        """
        if message.header.frame_id not in ("", self._frame):
            raise refuse("applied_torque: frame_id", message.header.frame_id, f'"{self._frame}"')
        torque = message.wrench.torque
        x, y, z = numbers("applied_torque", (torque.x, torque.y, torque.z), 3, LARGEST)
        self.value, self.end = (x, y, z), stamp + round(timeout * 1e9)

    def release(self) -> None:
        """End it."""
        self.value = NONE
