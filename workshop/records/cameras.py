"""A camera that films a point of the axis: any aim, lens, shutter, pixels and crop."""

from dataclasses import dataclass

import numpy as np

from workshop.records.bodies import Course, Real

INSTANTS = 5  # of an exposure, whose mean is the blurred point
PASSES = 3  # until the row of a point and the time at which that row was read agree


@dataclass(frozen=True)
class Camera:
    """A camera and its picture, whose u points to the right and v upwards.

    Attributes
    ----------
    place, aim : tuple of float
        Where it stands, and a point at which it looks, in lengths of the axis from the pivot.
    focal : float
        Focal length, in pixels.
    size : tuple of int
        Width and height of the picture, in pixels.
    roll : float
        By which the camera is turned about its line of sight, in rad.
    barrel : float
        Part by which a point half a width from the middle comes nearer to the middle.
    shutter, readout : float
        Seconds for which a frame is exposed, and from its first row to its last.
    stretch : float
        Part by which pixels are wider than they are high.
    crop : tuple of float
        Where the lower left corner of the picture is in the frame of the sensor, in pixels.
    is_mirrored : bool
        True if left and right are exchanged, as in the picture of a camera that faces its user.
    """

    place: tuple[float, float, float]
    aim: tuple[float, float, float]
    focal: float
    size: tuple[int, int] = (1280, 720)
    roll: float = 0.0
    barrel: float = 0.0
    shutter: float = 0.0
    readout: float = 0.0
    stretch: float = 0.0
    crop: tuple[float, float] = (0.0, 0.0)
    is_mirrored: bool = False

    def see(self, points: Real) -> Real:
        """Return the pixels (n, 2) of points (n, 3) in space."""
        place, aim = np.asarray(self.place), np.asarray(self.aim)
        ahead = (aim - place) / np.linalg.norm(aim - place)
        right = np.cross(ahead, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        up = np.cross(right, ahead)
        cos, sin = np.cos(self.roll), np.sin(self.roll)
        right, up = cos * right + sin * up, cos * up - sin * right
        rays = points - place
        depth = rays @ ahead
        seen = np.stack([rays @ right, rays @ up], axis=1) / depth[:, np.newaxis] * self.focal
        far = (seen**2).sum(axis=1, keepdims=True) / (self.size[0] / 2) ** 2
        seen = seen * (1 - self.barrel * far) / [1 + self.stretch, 1.0]
        if self.is_mirrored:
            seen = seen * [-1.0, 1.0]
        return np.asarray(seen + np.asarray(self.size) / 2 - self.crop)

    def film(self, course: Course, times: Real) -> Real:
        """Return the pixels (n, 2) of the end of the axis, by what each frame was exposed to."""
        delays = np.zeros(len(times))
        for _ in range(PASSES if self.readout else 1):
            instants = (np.arange(INSTANTS) + 0.5) / INSTANTS * self.shutter
            instants = instants if self.shutter else instants[:1]
            seen = np.mean(
                [self.see(course.at(times + delays + each)[0][:, :, 2]) for each in instants],
                axis=0,
            )
            delays = self.readout * np.clip(1 - seen[:, 1] / self.size[1], 0.0, 1.0)
        return np.asarray(seen)

    @property
    def elevation(self) -> float:
        """Angle of the line from the camera to the pivot below the horizontal, in rad."""
        x, y, z = self.place
        return float(np.arctan2(z, np.hypot(x, y)))

    @property
    def distance(self) -> float:
        """Distance from the pivot, in lengths of the axis."""
        return float(np.linalg.norm(self.place))
