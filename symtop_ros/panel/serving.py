"""What viser and its WebSocket server are made to do: one port for all, and nothing kept waiting.

Viser has no argument for most of it, so calls and classes of both are replaced here, and nowhere
else.
"""

import asyncio
import contextlib
import dataclasses
import logging
import socket
import warnings
from collections import deque
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import viser._scene_handles as viser_handles
import viser.infra._infra as viser_infra
import websockets.asyncio.server
from viser.infra._async_message_buffer import AsyncMessageBuffer
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from symtop_ros.arrays import Real

CONTROLS, SCENE = "/controls/", "/scene/"  # of the WebSockets, before the name of a page
# Messages to one page that it has not acknowledged. More of them would be old when they arrive.
MOST_SENT = 6
# A page may be closed while a message for it is made: viser warns of it, and nothing is lost.
warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")
Serve = Callable[[ServerConnection, str], Awaitable[None]]
Answer = Callable[[Request], Awaitable[Response | None]]


class LoopEvent(asyncio.Event):
    """An event that other threads do not set.

    Viser sets the event of a new message in the thread that draws, and then once more in the loop.
    The first may fail, or leave a page without its messages for ever, if the loop begins to wait
    at the same moment: events of asyncio belong to one thread.
    """

    def set(self) -> None:
        """Set the event in a thread with a loop, and do nothing in others."""
        if asyncio._get_running_loop() is not None:
            super().set()


@dataclasses.dataclass
class Buffer(AsyncMessageBuffer):
    """Viser's messages to its pages, which may be written in any thread."""

    message_event: asyncio.Event = dataclasses.field(default_factory=LoopEvent)


vars(viser_infra)["AsyncMessageBuffer"] = Buffer  # a name by which viser makes its buffers


def set_pose(
    current: Real, value: Any, _length: int, queue: Callable[[Any], None], make_message: Any
) -> None:
    """Set a position or an orientation of the scene, and send it if it has changed.

    Viser asks with a tolerance whether it has, which takes a fifth of the time of a frame.
    """
    pose = tuple(map(float, value))
    if pose != tuple(current.tolist()):
        current[:] = pose
        queue(make_message(pose))


vars(viser_handles)["_set_pose_vector"] = set_pose  # a name by which viser's handles set poses


@contextlib.contextmanager
def serving(listener: socket.socket, answer: Answer, controls: Serve) -> Iterator[None]:
    """In this context, let viser serve on an open socket and ask first how to answer a request."""
    original: Any = websockets.asyncio.server.serve

    def serve(scene: Any, _host: str, _port: int, **options: Any) -> Any:
        async def process(connection: PageConnection, request: Request) -> Response | None:
            response = await answer(request)
            if response and connection.is_head:
                response.body = b""
            return response

        async def handle(connection: ServerConnection) -> None:
            path = connection.request.path if connection.request else ""
            _pace(connection)
            if path.startswith(CONTROLS):
                await controls(connection, path.removeprefix(CONTROLS))
            else:
                await scene(connection)

        def select(connection: ServerConnection, protocols: Any) -> Any:
            return choose(connection, protocols) if protocols else None

        choose = options.pop("select_subprotocol")
        options |= {"process_request": process, "select_subprotocol": select}
        options |= {"create_connection": PageConnection}
        return original(handle, sock=listener, logger=_quiet(), **options)

    websockets.asyncio.server.serve = serve  # type: ignore[misc, assignment]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # type: ignore[misc]


class PageConnection(ServerConnection):
    """A connection that knows HEAD, which websockets refuses: GET without the content."""

    is_head, _has_begun = False, False

    def data_received(self, data: bytes) -> None:
        """Take over bytes; the first ones are the method of a request."""
        if not self._has_begun and data.startswith(b"HEAD "):
            self.is_head, data = True, data.replace(b"HEAD ", b"GET ", 1)
        self._has_begun = True
        super().data_received(data)


def _pace(connection: ServerConnection) -> None:
    """Let each message wait until the page has received all but the last few before it.

    Sockets and networks keep megabytes: a page behind a slow line would see what was seconds ago.
    The browser answers a ping when it has received what was sent before it. While a message waits,
    newer ones of viser replace the older ones of their kind.
    """
    send, sent = connection.send, deque[Awaitable[float]]()

    async def paced(message: Any, **options: Any) -> None:
        while len(sent) >= MOST_SENT:
            await asyncio.wait_for(asyncio.shield(sent.popleft()), None)
        await send(message, **options)
        sent.append(await connection.ping())

    connection.send = paced  # type: ignore[method-assign, assignment]


def _quiet() -> logging.Logger:
    """Return a logger that writes nothing: a peer that hangs up would be reported at length."""
    logger = logging.getLogger(__name__)
    logger.addHandler(logging.NullHandler())
    logger.propagate = False
    return logger
