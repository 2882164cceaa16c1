"""Two hosts on one machine, each with its network and shared memory, joined by a cable.

The cable ends in TAP devices and runs through this process, which loses, delays and reorders
frames as `tc ... netem` would, where the kernel has no netem as well.
"""

import contextlib
import fcntl
import heapq
import itertools
import os
import random
import select
import shutil
import struct
import subprocess
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

TUN = "/dev/net/tun"
TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
ADDRESSES = ("10.77.0.1", "10.77.0.2")
LINK = "eth0"
FRAME = 65536
SHARED_MEMORY = "mount -t tmpfs tmpfs /dev/shm && ip link set lo up && echo ready && exec cat"


def why_not() -> str:
    """Return why hosts cannot be made here; empty where they can."""
    missing = [each for each in ("ip", "unshare", "nsenter") if not shutil.which(each)]
    if missing:
        return f"{', '.join(missing)}: not installed"
    if os.geteuid() != 0:
        return "network namespaces are made by root only"
    if not os.access(TUN, os.W_OK):
        return f"{TUN} is not there"
    made = subprocess.run(["unshare", "--net", "--mount", "true"], capture_output=True, check=False)
    return made.stderr.decode().strip()


@dataclass(frozen=True)
class Weather:
    """Loss, delay and reordering of frames in each direction.

    `delay` and `jitter` are in seconds; a share `loss` is lost, and a share `reorder` overtakes
    the others for not being delayed at all.
    """

    loss: float = 0.0
    delay: float = 0.0
    jitter: float = 0.0
    reorder: float = 0.0

    def arrival(self, now: float, chance: random.Random) -> float | None:
        """Return when a frame arrives; None for never."""
        if chance.random() < self.loss:
            return None
        if chance.random() < self.reorder:
            return now
        return now + max(0.0, self.delay + chance.uniform(-self.jitter, self.jitter))


class Host:
    """A network and mount namespace, kept by a process that waits."""

    def __init__(self, address: str) -> None:
        self.address = address
        words = ["unshare", "--net", "--mount", "sh", "-c", SHARED_MEMORY]
        self._keeper = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self._keeper.stdout
        assert self._keeper.stdout.readline() == b"ready\n"

    @property
    def pid(self) -> int:
        """Process id of the keeper of its namespaces."""
        return self._keeper.pid

    def words(self, *command: str) -> list[str]:
        """Return the command line that runs a command on this host."""
        options = [f"--target={self.pid}", "--net", "--mount", f"--wd={Path.cwd()}"]
        return ["nsenter", *options, *command]

    def run(self, *command: str) -> str:
        """Run a command on this host to its end; return what it prints."""
        done = subprocess.run(self.words(*command), check=True, capture_output=True, text=True)
        return done.stdout

    def close(self) -> None:
        """Give the namespaces up."""
        self._keeper.kill()
        self._keeper.communicate()


class Cable:
    """Carries frames between two hosts, in a thread."""

    def __init__(self, hosts: list[Host]) -> None:
        self.weather = Weather()
        self.lost = 0  # frames
        self._chance = random.Random(1)
        self._ends = [_plug(host) for host in hosts]
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._carry)
        self._thread.start()

    def close(self) -> None:
        """Carry no more frames."""
        self._closing.set()
        self._thread.join()
        for end in self._ends:
            os.close(end)

    def _carry(self) -> None:
        other = dict(zip(self._ends, reversed(self._ends), strict=True))
        under_way: list[tuple[float, int, int, bytes]] = []
        numbers = itertools.count()
        while not self._closing.is_set():
            wait = min(0.1, max(0.0, under_way[0][0] - time.monotonic())) if under_way else 0.1
            for end in select.select(self._ends, [], [], wait)[0]:
                frame = os.read(end, FRAME)
                now = time.monotonic()
                arrival = self.weather.arrival(now, self._chance)
                if arrival is None:
                    self.lost += 1
                else:
                    heapq.heappush(under_way, (arrival, next(numbers), other[end], frame))
            while under_way and under_way[0][0] <= time.monotonic():
                _, _, end, frame = heapq.heappop(under_way)
                with contextlib.suppress(OSError):  # a link that is down
                    os.write(end, frame)


def _plug(host: Host) -> int:
    """Give a host a link; return the end of it that is here."""
    end = os.open(TUN, os.O_RDWR)
    request = struct.pack("16sH22x", b"tap%d", IFF_TAP | IFF_NO_PI)
    name = fcntl.ioctl(end, TUNSETIFF, request)[:16].rstrip(b"\0").decode()
    move = ["ip", "link", "set", name, "netns", str(host.pid), "name", LINK]
    subprocess.run(move, check=True, capture_output=True)
    host.run("ip", "address", "add", f"{host.address}/24", "dev", LINK)
    host.run("ip", "link", "set", LINK, "up")
    return end


@contextlib.contextmanager
def two_hosts() -> Iterator[tuple[Host, Host, Cable]]:
    """Make two hosts joined by a cable."""
    with contextlib.ExitStack() as stack:
        hosts = []
        for address in ADDRESSES:
            hosts.append(Host(address))
            stack.callback(hosts[-1].close)
        cable = Cable(hosts)
        stack.callback(cable.close)
        yield hosts[0], hosts[1], cable
