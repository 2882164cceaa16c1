"""Cost of the page: PYTHONPATH=test:test/load python test/panel/page_cost.py (1 minute)."""

from __future__ import annotations

import time
from typing import NamedTuple

from panel.pages import open_pages, running_panel
from usage import cpu_seconds, memory

SETTLE = 1.5  # s, after which the replay of the scene to new pages is over


class Cost(NamedTuple):
    """Updates per second of the slowest page, CPU time in %, and memory in MB."""

    updates: float
    cpu: float
    memory: float


def measure(pid: int, url: str, pages: int, seconds: float) -> Cost:
    """Return the cost of the server with so many pages, over some seconds."""
    if not pages:
        begin = cpu_seconds(pid)
        time.sleep(seconds)
        return Cost(0.0, 100 * (cpu_seconds(pid) - begin) / seconds, memory(pid))
    with open_pages(url, pages) as opened:
        time.sleep(SETTLE)
        begin, clock = cpu_seconds(pid), time.monotonic()
        updates = min(opened.rates(seconds))
        used = (cpu_seconds(pid) - begin) / (time.monotonic() - clock)
        return Cost(updates, 100 * used, memory(pid))


def main() -> None:
    """Print the table of docs/panel.md."""
    print("| pages | updates per s | CPU, % (one core) | memory, MB |")
    print("|--:|--:|--:|--:|")
    with running_panel() as (process, url):
        for pages in (1, 4, 10, 0):
            cost = measure(process.pid, url, pages, 10.0)
            print(
                f"| {pages} | {cost.updates:.0f} | {cost.cpu:.1f} | {cost.memory:.0f} |", flush=True
            )


if __name__ == "__main__":
    main()
