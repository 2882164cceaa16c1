"""Gravity and the sensor on a top: all that samples depend on besides the motion."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from symtop_ros.physics import STANDARD_GRAVITY, Body, Top
from symtop_ros.simulation.sensor.imu import MAGNETOMETER_NOISE, NOISE, Imu, Magnetometer
from symtop_ros.wire.diagnostics import write_text


@dataclass(frozen=True)
class Rig:
    """Gravity and the sensor: all that samples depend on besides the motion."""

    gravity: float = STANDARD_GRAVITY  # m/s^2
    imu: Imu | None = None  # the sensor on the top, or None

    def to_values(self) -> dict[str, str]:
        """Return the values for an event, in decimals that read back to the same doubles."""
        values = {"gravity": repr(self.gravity)}
        if imu := self.imu:
            values |= {
                "imu.mount": write_text((*imu.position, *imu.orientation)),
                "imu.noise": write_text([getattr(imu, name) for name in (*NOISE, "rate")]),
                "imu.seed": str(imu.seed),
                "imu.begin": str(imu.begin),
            }
            if found := imu.magnetometer:
                noise = [getattr(found, name) for name in MAGNETOMETER_NOISE]
                values |= {
                    "magnetic_field.vector": write_text(found.vector),
                    "magnetic_field.noise": write_text(noise),
                    "magnetic_field.seed": str(found.seed),
                }
        return values

    @classmethod
    def from_values(cls, values: Mapping[str, str]) -> "Rig":
        """Return the rig of an event."""
        gravity = float(values["gravity"])
        if not 0 < gravity < math.inf:
            raise ValueError(f"gravity must be > 0 m/s^2, got {gravity:g}")
        return cls(gravity, _read_imu(values) if "imu.mount" in values else None)


def _read_imu(values: Mapping[str, str]) -> Imu:
    a, b, c, x, y, z, w = map(float, values["imu.mount"].split())
    *noise, rate = map(float, values["imu.noise"].split())
    return Imu(
        (a, b, c),
        (x, y, z, w),
        **dict(zip(NOISE, noise, strict=True)),
        seed=int(values["imu.seed"]),
        rate=rate,
        begin=int(values["imu.begin"]),
        magnetometer=_read_magnetometer(values) if "magnetic_field.vector" in values else None,
    )


def _read_magnetometer(values: Mapping[str, str]) -> Magnetometer:
    x, y, z = map(float, values["magnetic_field.vector"].split())
    density, walk = map(float, values["magnetic_field.noise"].split())
    return Magnetometer((x, y, z), density, walk, int(values["magnetic_field.seed"]))


@lru_cache(maxsize=8)
def find_body(top: Top, gravity: float) -> Body | None:
    """Return the body that is chosen for a top; None if no body can be it."""
    try:
        return Body.of(top, gravity)
    except ValueError:
        return None
