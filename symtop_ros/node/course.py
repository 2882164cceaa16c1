"""The course of a run: a sample at every stamp of a grid, and an event for every change.

A change takes effect at the next stamp that is not published yet: samples before it belong to the
old motion, from it on to the new one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.clock import ROSClock
from rclpy.impl.rcutils_logger import RcutilsLogger
from std_msgs.msg import String

from symtop_ros.node.applied_torque import AppliedTorque
from symtop_ros.node.effort import SHARE, Effort, Shortfall
from symtop_ros.node.outputs import Outputs
from symtop_ros.node.parameters import Settings
from symtop_ros.node.ticker import CATCH_UP, Ticker
from symtop_ros.node.urdf import robot_description
from symtop_ros.physics import State, motion, perry
from symtop_ros.run.block import Block
from symtop_ros.run.events import PREFIX, Event
from symtop_ros.run.segment import Segment
from symtop_ros.wire.diagnostics import OK, Status, packed

AHEAD = 0.05  # s of samples that are computed at once; a kick makes them void
AT_ONCE, AT_ONCE_DRIVEN = 16, 4  # of them at most: the engine's work is parted in small pieces
SECOND = 1_000_000_000
JUMP = 1.0  # s; a clock that is set further than this has jumped
Request = Mapping[str, Any]


class Course:
    """What moves, how far it is published, and what acts on it.

    Parameters
    ----------
    settings : Settings
    start : State
        Of the first motion, which begins now.
    outputs : Outputs
        Where samples and events go.
    clock : ROSClock
        The node's.
    logger : RcutilsLogger

    Attributes
    ----------
    settings : Settings
        Those that hold; `apply` changes them.
    segment : Segment
        The motion of the next stamp.
    ticker : Ticker
        The grid of stamps.
    """

    def __init__(
        self,
        settings: Settings,
        start: State,
        outputs: Outputs,
        clock: ROSClock,
        logger: RcutilsLogger,
    ) -> None:
        self.settings, self._outputs = settings, outputs
        self._clock, self._logger = clock, logger
        self.ticker = Ticker(settings["publish_rate"], self.now)
        self._torque = AppliedTorque(self.frame)
        self._effort, self._spent = Effort(self.stamp), 0.0
        path = motion(settings.top, start, settings.friction, settings.steady_torque)
        self.segment = Segment.begin(path, self.stamp, settings["real_time_factor"])
        self._block = Block(self.segment, [])
        self._describe()

    @property
    def now(self) -> int:
        """Time by the node's clock, in ns."""
        return int(self._clock.now().nanoseconds)

    @property
    def simulated(self) -> bool:
        """Whether that is simulation time."""
        return self._clock.ros_time_is_active

    @property
    def stamp(self) -> int:
        """The next stamp to publish, in ns."""
        return self.ticker.next_stamp

    @property
    def state(self) -> State:
        """The state at that stamp."""
        return self.segment.state_at(self.stamp)

    @property
    def verdict(self) -> str:
        """What kind of motion it is, and what follows from its start."""
        path = self.segment.path
        return f"{path.kind}: {perry(path.top, path.start)}"

    # samples

    def advance(self) -> bool:
        """Publish what is due; return whether the next samples are at hand."""
        self._release_torque()
        return self._publish() and self._prepare_block()

    def _publish(self) -> bool:
        """Publish what is due; return whether it was at hand."""
        ready = self._prepare_block()
        if ready:
            self._publish_due()
        return ready

    def _publish_due(self) -> None:
        missed, catch_up = self.ticker.missed, JUMP if self.simulated else CATCH_UP
        for stamp in self.ticker.due(self.now, catch_up, self._block.last):
            self._outputs.send_sample(stamp, self._block)
        if self.ticker.missed > missed:
            self._tell_gap(self.ticker.missed - missed)

    def _prepare_block(self) -> bool:
        """Have the samples of the next stamps at hand; return whether they are."""
        stamp, segment = self.stamp, self.segment
        if self._block.holds(segment, stamp):
            return True
        stamps = self.ticker.grid(stamp, self._length_of_block())
        if any(self._torque.value):
            stamps = [each for each in stamps if each < self._torque.end]
        if not stamps:  # it ends with the next turn
            return False
        ready = self._effort.prepare(segment, stamps[-1])
        if ready:
            self._block = self._block.following(segment, stamps)
        elif self._effort.shortfall:
            self._slow_down(stamp, self._effort.shortfall)
        return ready

    def _length_of_block(self) -> int:
        """Few samples where a motion begins, so that its first one comes soon, then more."""
        segment, rate = self.segment, self.ticker.rate
        most = AT_ONCE_DRIVEN if segment.path.driven else AT_ONCE
        grown = 4 * self._block.length if self._block.segment is segment else 1
        return max(1, min(most, grown, int(AHEAD * rate)))

    def _tell_gap(self, missed: int) -> None:
        seconds = missed / self.settings["publish_rate"]
        self._logger.warning(
            f"no samples for {seconds:.3g} s: the process was stopped, or has too little time; "
            f"{missed} samples are missed, the motion is where the clock says",
            throttle_duration_sec=1.0,
        )

    # the engine

    def settle(self) -> None:
        """Begin the turn of a request: the state that it finds is at hand."""
        self._release_torque()
        self._keep_up(self.stamp)

    def _keep_up(self, stamp: int) -> None:
        """Have the state at a stamp at hand; a motion that is too fast for it is slowed down."""
        while not self._effort.prepare(self.segment, stamp):
            if self._effort.shortfall:
                self._slow_down(stamp, self._effort.shortfall)

    def _slow_down(self, stamp: int, shortfall: Shortfall) -> None:
        reached, factor = shortfall
        asked, before = self.segment.factor, self.segment.path.at(reached)
        self.segment = self.segment.slowed(reached, factor, stamp)
        verdict = f"the engine cannot keep up: real-time factor {asked:.3g} -> {factor:.3g}"
        self._logger.warning(verdict)
        self.announce("pace", verdict, {"reached": reached}, before, stamp)

    def speed_up(self) -> None:
        """Go back towards the real-time factor that is asked for, where there is time for it."""
        work, self._spent = self._effort.spent - self._spent, self._effort.spent
        now, asked = self.segment.factor, self.settings["real_time_factor"]
        if now < asked and work < SHARE / 2:
            factor = min(asked, 2 * now) if self.segment.path.driven else asked
            before = self.state
            self.segment = self.segment.with_factor(factor, self.stamp)
            self.announce("pace", f"real-time factor {now:.3g} -> {factor:.3g}", {}, before)

    # changes

    def change(self, name: str, segment: Segment, request: Request, verdict: str) -> str:
        """Go on with another segment, and announce it; return the verdict."""
        before, self.segment = self.state, segment
        self.announce(name, verdict, request, before)
        return verdict

    def change_at_once(
        self, name: str, segment: Segment, request: Request, verdict: Callable[[], str]
    ) -> str:
        """Do the same, but publish the first sample before there are words for it.

        In the log the event comes first all the same.
        """
        stamp, before = self.stamp, self.state
        self.segment = segment
        with self._outputs.behind_events():
            self._publish()
            words = verdict()
            self._publish()
            self.announce(name, words, request, before, stamp)
        return words

    def follow_jump(self, now: int) -> None:
        """Take the motion along, from where it is, to where the clock has jumped (ns)."""
        stamp = self.stamp
        self._keep_up(stamp)
        before = self.state
        self.segment = self.segment.moved(stamp, now)
        self.ticker.restart(self.settings["publish_rate"], now)
        self._torque.end += now - stamp
        self.announce("clock", "the clock has jumped", {"from": stamp, "to": now}, before)

    def hold_torque(self, message: WrenchStamped) -> None:
        """Let a torque act from the next stamp on, until it runs out; RefusedError if it cannot."""
        stamp = self.stamp
        self._torque.hold(message, stamp, self.settings["applied_torque_timeout"])
        self._drive(stamp, "an applied torque acts")

    def _release_torque(self) -> None:
        if any(self._torque.value) and self.stamp >= self._torque.end:
            self._keep_up(self._torque.end)
            self._torque.release()
            self._drive(self._torque.end, "the applied torque has run out")

    def _drive(self, stamp: int, verdict: str) -> None:
        """Go on from a stamp under the torque that acts now, if it is another one."""
        steady, held = self.settings.steady_torque, self._torque.value
        torque = tuple(a + b for a, b in zip(steady, held, strict=True))
        if torque != self.segment.path.applied_torque:
            before = self.segment.state_at(stamp)
            self.segment = self.segment.changed(stamp, torque=torque)
            self.announce("torque", verdict, {"torque": torque}, before, stamp)

    def apply(self, settings: Settings) -> None:
        """Go on with other settings, from the state of now."""
        old, self.settings = self.settings, settings
        changes = {name: value for name, value in settings.values.items() if value != old[name]}
        if not changes:
            return
        stamp, before = self.stamp, self.state
        if (settings.top, settings.friction) != (old.top, old.friction):
            self.segment = self.segment.changed(stamp, settings.top, settings.friction)
        if settings.top != old.top:
            self._describe()
        if "real_time_factor" in changes:
            self.segment = self.segment.with_factor(settings["real_time_factor"], stamp)
        if "publish_rate" in changes:
            self.ticker.restart(settings["publish_rate"], stamp)
            self._block = Block(self.segment, [])  # of the old grid
        verdict = "; ".join(f"{name} is now {value}" for name, value in changes.items())
        self.announce("parameters", verdict, changes, before)
        if settings.steady_torque != old.steady_torque:
            self._drive(stamp, "the steady torque is another one")

    # words

    @property
    def frame(self) -> str:
        """Name of the world."""
        return str(self.settings["world_frame"])

    def announce(
        self,
        name: str,
        verdict: str,
        request: Request,
        before: State,
        stamp: int | None = None,
    ) -> None:
        """Publish the event with which the segment of now has begun, or something was done."""
        stamp = self.stamp if stamp is None else stamp
        event = Event.of(stamp, name, verdict, request, before, self.segment)
        status = Status(stamp, OK, PREFIX + name, verdict, event.values)
        self._outputs.events.send(stamp, packed(stamp, self.frame, [status]))

    def _describe(self) -> None:
        frames = self.settings["world_frame"], self.settings["top_frame"]
        text = robot_description(self.settings.top, *frames)
        self._outputs.description.send_message(self.stamp, String(data=text))
