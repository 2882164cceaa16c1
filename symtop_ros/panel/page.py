"""The page: scene, controls and charts around one top, drawn 60 times a second while watched."""

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import imageio.v3 as iio
import numpy as np
from viser import CameraHandle, ClientHandle, IcosphereHandle, SceneNodeDragEvent
from viser import _messages as messages

from symtop_ros.arrays import Real
from symtop_ros.panel.actions import Actions
from symtop_ros.panel.channel import LOG, Pages
from symtop_ros.panel.server import File, PageServer
from symtop_ros.panel.source import Source
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.validation import RefusedError, one_line
from symtop_ros.web.facts import describe
from symtop_ros.web.run import Run
from symtop_ros.web.saved import save_run
from symtop_ros.web.scene import EYES, FICTITIOUS, TARGETS, Scene, layer_node

RATE, CROWDED_RATE = 60.0, 40.0  # frames per second
CROWD = 4  # pages above which fewer frames are drawn: each page is sent its own copy
CHART_EVERY, TEXT_EVERY = 6, 15  # frames
FITTING = 0.85  # width over height at which the whole sphere is visible
RESIZED = 0.1  # relative change of the width after which the camera is placed anew
UNWATCHED = 0.5  # s between two looks at the events of a top without pages
REMEMBERED = 100  # pages whose choice of layers is known; a page may load its scene again
RENDERING = 20.0  # s for a picture, which a browser without a graphics card takes long to draw


class Page:
    """One top on a server. Any number of browsers may show it, each with its own camera."""

    def __init__(self, source: Source, host: str, port: int) -> None:
        self.source, self.run = source, Run()
        self.actions = Actions(source, self.run)
        self._connected, self._ending = threading.Event(), threading.Event()
        self._lock = threading.Lock()  # of the run: the pages read it in another thread
        self.pages = Pages(self.run, self.actions, self._lock)
        self.server = PageServer(host, port, self.pages.serve, self._files())
        self.pages.show, self.pages.wake = self._show_layer, self._connected.set
        self._scene = Scene(self.server)
        self._view = self._scene.view
        self._pull: tuple[int, Real] | None = None  # who pulls the axle, and where to
        self._scene.handle.on_drag(self._drag)
        # Two threads place a camera: one greets a page, the other follows the scene.
        self._placing = threading.Lock()
        self._sizes: dict[int, tuple[int, int]] = {}  # of the scene on each page, in pixels
        self._shown: dict[str, dict[str, bool]] = {}  # what each page has chosen, by layers
        self._outdated = True  # True if the pages have not got the facts
        self.server.on_client_connect(self._greet)
        self.server.on_client_disconnect(self._forget)
        self.server.gui.configure_theme(show_logo=False, show_share_button=False)
        self.frames = 0
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the drawing, the server and the top."""
        self._ending.set()
        self._connected.set()
        self._thread.join()
        self.server.stop()
        self.source.close()

    def _greet(self, client: ClientHandle) -> None:
        """Begin to draw, and fit the camera to the page, also when its size changes."""
        self._connected.set()
        for layer, shown in dict(self._layers_of(client.client_id)).items():
            _set_visible(client, layer, shown)
        client.camera.on_update(self._fit)
        self._fit(client.camera)

    def _fit(self, camera: CameraHandle) -> None:
        """Show the whole scene, however narrow the page is."""
        page, size = camera.client.client_id, (camera.image_width, max(camera.image_height, 1))
        with self._placing:
            before, self._sizes[page] = self._sizes.get(page), size
            is_resized = before is None or abs(size[0] / before[0] - 1) > RESIZED
            # A page that has just opened may go back to its first camera after it was placed.
            if is_resized or np.allclose(camera.position, EYES[0]):
                self._place(camera, size)

    def _place(self, camera: CameraHandle, size: tuple[int, int]) -> None:
        eye, target = (np.array(each[self._scene.view]) for each in (EYES, TARGETS))
        distance = max(1.0, FITTING * size[1] / max(size[0], 1))
        camera.position = distance * (eye - target) + target
        camera.look_at = target  # last, for a new position moves it too

    def _forget(self, client: ClientHandle) -> None:
        self._sizes.pop(client.client_id, None)

    def _work(self) -> None:
        due, watched = time.monotonic(), None
        while not self._ending.is_set():
            self._connected.clear()
            pages = max(len(self.pages), len(self.server.get_clients()))
            if watched != bool(pages):
                watched = bool(pages)
                self.source.watch(watched)
            if pages:
                self._try_to_draw()
                due = max(due + 1 / (RATE if pages <= CROWD else CROWDED_RATE), time.monotonic())
                self._ending.wait(due - time.monotonic())
            else:  # the events of a node are taken, its samples are not
                with self._lock:
                    self._follow()
                self._connected.wait(UNWATCHED)

    def _try_to_draw(self) -> None:
        """Draw a frame. After a bug the page says so, and the next frame may be drawn."""
        try:
            self._draw()
        except Exception as error:
            self.pages.notify(f"drawing failed: {type(error).__name__}: {one_line(error)}")

    def _draw(self) -> None:
        """Draw a frame; the charts change less often."""
        with self.server.atomic(), self._lock:
            self._follow()
            pull = self._pull
            self._scene.shows_torques = any(
                self._layers_of(client).get(FICTITIOUS) for client in self.server.get_clients()
            )
            self._scene.draw(self.run, pull[1] if pull else None)
            driven = self.run.motion is not None and self.run.motion.is_driven
            if self._outdated or (driven and self.frames % TEXT_EVERY == 0):
                self.pages.facts, self._outdated = describe(self.run), False
                self.pages.update()
        if self._view != self._scene.view:
            self._move_cameras()
        self.server.flush()  # else viser waits for more, up to a sixtieth of a second
        if self.frames % CHART_EVERY == 0:
            self.pages.update()
        self.frames += 1

    def _move_cameras(self) -> None:
        with self._placing:
            self._view = self._scene.view
            for client in self.server.get_clients().values():
                if client.client_id in self._sizes:
                    self._place(client.camera, self._sizes[client.client_id])

    def _follow(self) -> list[Event]:
        """Take over what happened to the top; return the events."""
        events = self.run.follow(self.source.batch())
        for sentence in self.source.reports():
            self.pages.notify(sentence)
        if events and self.run.segment is not None:
            self._scene.begin_motion(self.run.segment, events[-1].state())
            self._outdated = True
        return events

    async def _drag(self, event: SceneNodeDragEvent[IcosphereHandle]) -> None:
        """Follow a pull at the axle, and kick the top at its end."""
        if event.phase != "end":
            self._pull = (event.client_id, np.array(event.end_position))
            return
        pull, self._pull = self._pull, None
        # The end of a drag is also reported when a page is closed in its middle: that is no kick.
        if pull and pull[0] == event.client_id in self.server.get_clients():
            self.server.get_event_loop().run_in_executor(None, self._kick, pull[1])

    def _kick(self, end: Real) -> None:
        try:
            self.actions.pull(end)
        except RefusedError as refusal:
            self.pages.notify(str(refusal))

    # What one page asks for

    def _clients(self, page: str) -> list[ClientHandle]:
        clients = self.server.get_clients().values()
        return [
            client for client in clients if page and self.server.page_of(client.client_id) == page
        ]

    def _layers_of(self, client: int) -> dict[str, bool]:
        """Return what the page of a client of viser has chosen to show or to hide."""
        return self._shown.get(self.server.page_of(client), {})

    def _show_layer(self, page: str, layer: str, shown: bool) -> None:
        """Show or hide a layer on one page. Viser's handles change all pages."""
        self._shown.setdefault(page, {})[layer] = shown
        if len(self._shown) > REMEMBERED:
            del self._shown[next(iter(self._shown))]
        for client in self._clients(page):
            _set_visible(client, layer, shown)

    def _files(self) -> dict[str, Callable[[str], File | None]]:
        return {
            "/series.csv": lambda _: File(self._locked(self.run.csv).encode(), "text/csv"),
            "/run.html": lambda _: self.save_run(),
            "/picture.png": self._draw_picture,
            LOG: lambda _: self._read_log(),
        }

    def _locked(self, act: Callable[[], Any]) -> Any:
        with self._lock:
            return act()

    def save_run(self) -> File | None:
        """Return the run so far as a page; None if nothing has moved yet."""
        events, end = self._locked(
            lambda: ([each.event for each in self.run.moments], self.run.stamp)
        )
        try:
            return File(save_run(events, end).encode(), "text/html; charset=utf-8")
        except ValueError:
            return None

    def _read_log(self) -> File | None:
        log: Path | None = self.source.log
        return None if log is None else File(log.read_bytes(), "application/octet-stream")

    def _draw_picture(self, page: str) -> File | None:
        """Return the page's own view of the scene, in the size that it has there."""
        for client in self._clients(page):
            width, height = client.camera.image_width, client.camera.image_height
            image = client.get_render(height, width, transport_format="png", timeout=RENDERING)
            return File(iio.imwrite("<bytes>", image, extension=".png"), "image/png")
        return None


def _set_visible(client: ClientHandle, layer: str, shown: bool) -> None:
    message = messages.SetSceneNodeVisibilityMessage(layer_node(layer), shown)
    client._websock_connection.queue_message(message)
