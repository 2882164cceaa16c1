"""Addresses that processes listen on."""

import contextlib

import psutil


def tcp_addresses(pid: int) -> set[tuple[str, int]]:
    """Addresses and ports that a process and its children accept connections on."""
    process = psutil.Process(pid)
    found = set()
    for each in (process, *process.children(recursive=True)):
        with contextlib.suppress(psutil.Error):  # it has ended since
            sockets = each.net_connections("tcp")
            found |= {tuple(each.laddr) for each in sockets if each.status == psutil.CONN_LISTEN}
    return found


def udp_addresses(ports: range) -> set[tuple[str, int]]:
    """Addresses and ports, of those given, that anybody receives datagrams on."""
    sockets = psutil.net_connections("udp")
    return {tuple(each.laddr) for each in sockets if each.laddr and each.laddr.port in ports}
