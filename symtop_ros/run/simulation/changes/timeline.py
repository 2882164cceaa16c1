"""The timeline of a run: what holds at a stamp, and what each command makes of it.

A command gives the timeline that follows, with the change that led to it. Here are those that ask
more than `follow` knows: settings, and what was held or started before. Nothing here has a clock, a
lock or a side effect; `simulation` decides at which stamp a change takes effect.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from symtop_ros.base.arrays import Vector
from symtop_ros.base.refusals import refuse, vector
from symtop_ros.physics import State
from symtop_ros.run.simulation.budget import Shortfall
from symtop_ros.run.simulation.changes.follow import Act, Change, Request, demand_a_day, follow
from symtop_ros.run.simulation.changes.outcomes import Failure, Pace, Torque
from symtop_ros.run.simulation.changes.requests import initial_state, plan_start, start_motion
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import MAX_MOMENT, NO_TORQUE, Settings
from symtop_ros.run.wire.layout import NANOSECONDS


@dataclass(frozen=True)
class Timeline:
    """A run from one change to the next."""

    settings: Settings
    change: Change  # the last one, whose segment holds from it on
    start: State  # the last initial conditions
    origin: Act  # with which the motion of the segment began
    held_torque: Vector = NO_TORQUE  # from ~/applied_torque
    torque_end: int = 0  # stamp in ns at which the held torque ends

    @classmethod
    def begin(cls, settings: Settings, stamp: int) -> "Timeline":
        """Return the timeline that starts at a stamp (ns) from the initial conditions."""
        motion = start_motion(settings)
        # With publish_clock the clock has this factor.
        factor = 1.0 if settings.publish_clock else settings.real_time_factor
        segment = demand_a_day(Segment.begin(motion, stamp, factor, settings.rig(stamp)))
        change = Change.begin(segment)
        return cls(settings, change, motion.start, change.act)

    @property
    def segment(self) -> Segment:
        """The motion from the last change on."""
        return self.change.segment

    @property
    def since(self) -> str:
        """The event with which the motion of the segment began, and its stamp."""
        return f"{self.origin.name} at stamp {self.origin.stamp / NANOSECONDS:.9f} s"

    def announce(self, scene: str) -> "Timeline":
        """Return the timeline with what the first event of a run says: the scene."""
        return replace(self, change=Change.begin(self.segment, {"scene": scene}))

    def follow(self, act: Act, before: State | None = None) -> "Timeline":
        """Return the timeline after an act; `before` is the state right before it, where known."""
        change = follow(self.segment, act, before)
        is_continued = change.segment.motion is self.segment.motion
        return replace(self, change=change, origin=self.origin if is_continued else act)

    def restart(self, stamp: int, values: Request | None = None) -> "Timeline":
        """Restart from named initial conditions, or without them from the last ones."""
        clamped = self.settings.initial.clamped
        if values is None:
            return self.follow(Act("reset", stamp, {}, self.start, clamped=clamped))
        start, solved = plan_start(self.settings.top, self.settings.initial, values)
        act = Act("start", stamp, values, start, clamped=clamped, solved=solved)
        return replace(self, start=start).follow(act)

    def move(self, stamp: int, now: int) -> "Timeline":
        """Continue the state of a stamp at the time (ns) to which the clock jumped."""
        moved = replace(self, torque_end=self.torque_end + now - stamp)
        return moved.follow(Act("clock", now, {"from": stamp, "to": now}))

    def slow_down(self, stamp: int, shortfall: Shortfall) -> "Timeline":
        """Continue at a real-time factor that can be kept, from the time that was reached."""
        reached, factor, lack = shortfall
        kind: Literal["slowed", "starved"] = "starved" if lack else "slowed"
        told = Pace(kind, self.segment.factor, factor, *(lack or ()))
        return self.follow(Act("pace", stamp, {"reached": reached}, factor=factor, told=told))

    def set_pace(self, stamp: int, current: float, factor: float) -> "Timeline":
        """Continue at another real-time factor than the current one."""
        told = Pace("slowed" if factor < current else "changed", current, factor)
        return self.follow(Act("pace", stamp, {}, factor=self._find_factor(factor), told=told))

    def _find_factor(self, factor: float) -> float:
        """Return the factor of a segment; with publish_clock the clock has it."""
        return self.segment.factor if self.settings.publish_clock else factor

    def hold_torque(self, stamp: int, torque: Sequence[float], frame: str = "") -> "Timeline":
        """Apply a torque (3,) in N m until its time-out."""
        world = self.settings.world_frame
        if frame not in ("", world):
            raise refuse("applied_torque frame_id", f'"{world}" or empty', frame)
        x, y, z = vector("applied_torque", torque, 3, MAX_MOMENT, "N m, world frame")
        end = stamp + round(self.settings.applied_torque_timeout * NANOSECONDS)
        return replace(self, held_torque=(x, y, z), torque_end=end)._apply_torque(stamp, "applied")

    def release_torque(self, stamp: int) -> "Timeline":
        """Continue without the held torque."""
        return replace(self, held_torque=NO_TORQUE)._apply_torque(stamp, "released")

    def _apply_torque(
        self, stamp: int, kind: Literal["applied", "released", "steady"]
    ) -> "Timeline":
        a, b, c = self.settings.steady_torque
        x, y, z = self.held_torque
        total = (a + x, b + y, c + z)
        return self.follow(Act("torque", stamp, {"torque": total}, told=Torque(kind, total)))

    def change_settings(self, settings: Settings, stamp: int) -> list["Timeline"]:
        """Continue from the current state with other settings: one timeline for each event."""
        old, start = self.settings, self.start
        changes = {
            name: value for name, value in settings.values.items() if value != old.values[name]
        }
        if not changes:
            return []
        if settings.initial != old.initial:  # ~/reset then starts from them
            start = initial_state(settings.top, settings.initial, {})
        first = replace(self, settings=settings, start=start).follow(
            Act(
                "parameters",
                stamp,
                changes,
                factor=self._find_factor(settings.real_time_factor),
            )
        )
        torque = first._apply_torque(stamp, "steady")
        return [first] if torque.segment is first.segment else [first, torque]

    def fail(self, stamp: int, failure: Failure, before: Segment) -> "Timeline":
        """Report an action that failed, whatever it has left of the segment before."""
        act = Act("failure", stamp, {}, told=failure, left=self.segment)
        return replace(self, change=follow(before, act))

    def end(self, stamp: int, failure: Failure) -> "Timeline":
        """Report a failure that ends the run: the motion stands still."""
        act = Act("failure", stamp, {}, told=failure, left=self.segment.pause(stamp))
        return replace(self, change=follow(self.segment, act))
