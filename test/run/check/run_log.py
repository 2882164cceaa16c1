"""A log of a session with every kind of event, and its messages in memory."""

from pathlib import Path

from run.session.test_outputs import Program, advance, start

from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.source import MessageSource

WRENCH = (1e-4, 0.0, 2e-4)  # N m


def write_log(folder: Path, **changes: object) -> Path:
    """Write the log of a run with all services, settings, a torque, a jump and diagnostics."""
    host = Program(publishes=False)
    enabled = dict.fromkeys(("imu__enabled", "magnetic_field__enabled", "odometry__enabled"), True)
    sensors = {**enabled, "imu__position": [0.0, 0.0, 0.02]}
    session, clock = start(host, record__directory=str(folder), **{**sensors, **changes})

    def ask(service: str, value: object = None) -> None:
        granted, text = session.answer(service, lambda: value)
        assert granted, text
        advance(session, clock, 0.02)

    ask("record", True)
    session.keep_up()
    ask("hurry_precession")
    ask("kick", {"angular_impulse": [1e-5, 0.0, -2e-5]})
    ask("kick", {"precession_rate": 9.0, "hold": "spin_momentum"})
    ask("kick", {"axle_impulse": 2**-17, "rate": 100.0, "number": 20})  # ended by the next start
    session.keep_up()
    ask("pause", True)
    ask("step", {"duration": 0.0125})
    ask("pause", False)
    ask("set_initial_conditions", {"theta": 0.7, "psi_dot": 150.0, "precession": "slow"})
    ask("reset")
    session.hold_torque(WRENCH)
    advance(session, clock, 0.05)
    session.keep_up()
    advance(session, clock, 0.3)  # it has ended
    assert not session.apply_settings({"top.Mgl": 0.05, "friction.axial": 1e-6})
    assert not session.apply_settings({"real_time_factor": 0.5, "publish_rate": 100.0})
    advance(session, clock, 0.05)
    session.keep_up()
    session.simulation.begin_jump()
    clock.now += 5_000_000_000
    session.simulation.end_jump(True)
    advance(session, clock, 0.05)
    session.keep_up()
    session.close()
    (path,) = folder.glob("*.mcap")
    return path


class Memory(MessageSource):
    """A source of messages that can be changed."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        file = McapFile(path)
        self.messages = [message for chunk in file.chunks() for message in chunk]
        self.schemas, self.channels, self.metadata = file.schemas, file.channels, file.metadata
        assert not file.problems

    def _read(self):
        """Yield the messages."""
        yield list(self.messages)

    def keep(self, *topics: str) -> None:
        """Leave only the events and the messages of some topics."""
        kept = {"/top/events", *topics}
        self.messages = [m for m in self.messages if self.channels[m.channel_id].topic in kept]

    def places(self, topic: str) -> list[int]:
        """Places of the messages of a topic."""
        topics = [self.channels[message.channel_id].topic for message in self.messages]
        return [place for place, each in enumerate(topics) if each == topic]
