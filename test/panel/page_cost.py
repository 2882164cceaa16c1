"""Cost of the page: PYTHONPATH=test python test/panel/page_cost.py (1 minute)."""

from __future__ import annotations

import time
from typing import NamedTuple

from panel.pages import open_pages, running_panel
from panel.slow_line import slow_line

from workshop.load.usage import cpu_seconds, memory

SETTLE = 1.5  # s, after which the replay of the scene to new pages is over


SLOW = 300e3  # bytes per second of a slow line


class Cost(NamedTuple):
    """Updates and kB per second of the slowest page, CPU time in %, and memory in MB."""

    updates: float
    kilobytes: float
    cpu: float
    memory: float


def measure(pid: int, url: str, pages: int, seconds: float) -> Cost:
    """Return the cost of the server with so many pages, over some seconds."""
    if not pages:
        begin = cpu_seconds(pid)
        time.sleep(seconds)
        return Cost(0.0, 0.0, 100 * (cpu_seconds(pid) - begin) / seconds, memory(pid))
    with open_pages(url, pages) as opened:
        time.sleep(SETTLE)
        begin, clock = cpu_seconds(pid), time.monotonic()
        before = max(opened.bytes)
        updates = min(opened.rates(seconds))
        passed = time.monotonic() - clock
        kilobytes = (max(opened.bytes) - before) / passed / 1000
        return Cost(updates, kilobytes, 100 * (cpu_seconds(pid) - begin) / passed, memory(pid))


def measure_age(url: str, rate: float, seconds: float) -> float:
    """Return the largest age in s that a frame has when it has come over a slow line."""
    with slow_line(url, rate) as address, open_pages(address) as opened:
        time.sleep(SETTLE)
        opened.ages.clear()
        time.sleep(seconds)
        return max(opened.ages)


def main() -> None:
    """Print the table of docs/panel.md."""
    print("| pages | updates per s | kB per s and page | CPU, % (one core) | memory, MB |")
    print("|--:|--:|--:|--:|--:|")
    with running_panel() as (process, url):
        for pages in (1, 4, 10, 0):
            cost = measure(process.pid, url, pages, 10.0)
            print(
                f"| {pages} | {cost.updates:.0f} | {cost.kilobytes:.0f} | {cost.cpu:.1f} "
                f"| {cost.memory:.0f} |",
                flush=True,
            )
        for rate in (SLOW, SLOW / 10):
            print(f"oldest frame at {rate / 1000:g} kB/s: {measure_age(url, rate, 10.0):.2f} s")


if __name__ == "__main__":
    main()
