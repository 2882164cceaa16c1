"""The server of a page in a thread of the test."""

import contextlib
import threading
from collections.abc import Iterator
from typing import Any

from symtop_ros.page.panel.server import LOCAL_HOST, PageServer


@contextlib.contextmanager
def serving(page: str, node: Any = None, port: int = 0) -> Iterator[PageServer]:
    """Serve a page, and its node if it has one, until the end of the block."""
    server = PageServer(LOCAL_HOST, port, page, node)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
