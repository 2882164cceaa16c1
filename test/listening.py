"""Addresses that processes listen on, from /proc."""

from __future__ import annotations

import contextlib
import os
import socket
import struct
from collections.abc import Iterator
from pathlib import Path

PROC = Path("/proc")
LISTENING = "0A"


def tcp_addresses(pid: int) -> set[tuple[str, int]]:
    """Addresses and ports that a process and its children accept connections on."""
    inodes = {inode for each in _family(pid) for inode in _sockets(each)}
    rows = (row for name in ("tcp", "tcp6") for row in _rows(name))
    return {
        (address, port)
        for address, port, state, inode in rows
        if state == LISTENING and inode in inodes
    }


def udp_addresses(ports: range) -> set[tuple[str, int]]:
    """Addresses and ports, of those given, that anybody receives datagrams on."""
    rows = (row for name in ("udp", "udp6") for row in _rows(name))
    return {(address, port) for address, port, _, _ in rows if port in ports}


def _rows(name: str) -> Iterator[tuple[str, int, str, str]]:
    """Local address, port, state and inode of each socket of a protocol."""
    for line in (PROC / "net" / name).read_text().splitlines()[1:]:
        words = line.split()
        address, _, port = words[1].partition(":")
        yield _readable(address), int(port, 16), words[3], words[9]


def _readable(address: str) -> str:
    """The usual notation of an address; the kernel writes words in native byte order."""
    words = [int(address[i : i + 8], 16) for i in range(0, len(address), 8)]
    family = socket.AF_INET if len(words) == 1 else socket.AF_INET6
    return socket.inet_ntop(family, struct.pack(f"={len(words)}I", *words))


def _family(pid: int) -> Iterator[int]:
    yield pid
    for task in (PROC / str(pid) / "task").iterdir():
        children = ""
        with contextlib.suppress(OSError):  # a thread that has ended since
            children = (task / "children").read_text()
        for child in children.split():
            yield from _family(int(child))


def _sockets(pid: int) -> Iterator[str]:
    for link in (PROC / str(pid) / "fd").iterdir():
        target = ""
        with contextlib.suppress(OSError):  # closed since
            target = os.readlink(link)
        if target.startswith("socket:["):
            yield target[8:-1]
