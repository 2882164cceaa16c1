"""The page: scene, controls and charts around one top, drawn 60 times a second while watched."""

import threading
import time

import numpy as np
from viser import CameraHandle, ClientHandle, IcosphereHandle, SceneNodeDragEvent

from symtop_ros.arrays import Real
from symtop_ros.panel.actions import Actions
from symtop_ros.panel.charts import WIDTH, Charts
from symtop_ros.panel.controls import Controls
from symtop_ros.panel.run import Run
from symtop_ros.panel.scene import EYE, TARGET, Scene
from symtop_ros.panel.server import PageServer
from symtop_ros.panel.source import Source
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.validation import one_line

RATE, CROWDED_RATE = 60.0, 40.0  # frames per second
CROWD = 4  # pages above which fewer frames are drawn: each page is sent its own copy
CHART_EVERY, TEXT_EVERY = 6, 15  # frames
FITTING = 0.85  # width over height at which the whole sphere is visible
RESIZED = 0.1  # relative change of the width after which the camera is placed anew
UNWATCHED = 0.5  # s between two looks at the events of a top without pages


class Page:
    """One top on a server. Any number of browsers may show it, each with its own camera."""

    def __init__(self, source: Source, host: str, port: int) -> None:
        self.source, self.run = source, Run()
        self.actions = Actions(source, self.run)
        self.server = PageServer(host, port, self._take_link)
        self._scene = Scene(self.server)
        self._charts = Charts(self.server)
        self._controls = Controls(self.server, self.actions, self.run, self._scene)
        self._pull: tuple[int, Real] | None = None  # who pulls the axle, and where to
        self._scene.handle.on_drag(self._drag)
        self._connected, self._ending = threading.Event(), threading.Event()
        self._sizes: dict[int, tuple[int, int]] = {}  # of the scene on each page, in pixels
        self.server.on_client_connect(self._greet)
        self.server.on_client_disconnect(self._forget)
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
        """Begin to draw, and fit the layout to the page, also when its size changes."""
        self._connected.set()
        client.camera.on_update(self._fit)
        self._fit(client.camera)

    def _fit(self, camera: CameraHandle) -> None:
        """Stack the panels where there is more height than width, and show the whole sphere."""
        page, size = camera.client.client_id, (camera.image_width, max(camera.image_height, 1))
        if self._sizes.get(page) == size:
            return
        before, self._sizes[page] = self._sizes.get(page), size
        width, height = size
        if 2 * width < height and width + WIDTH < height:
            self._charts.stack(camera.client)
        if before is None or abs(width / before[0] - 1) > RESIZED:
            distance = max(1.0, FITTING * height / max(width, 1))
            camera.position = distance * (np.array(EYE) - TARGET) + TARGET
            camera.look_at = TARGET  # last, for a new position moves it too

    def _forget(self, client: ClientHandle) -> None:
        self._sizes.pop(client.client_id, None)

    def _work(self) -> None:
        due, watched = time.monotonic(), None
        while not self._ending.is_set():
            self._connected.clear()
            pages = len(self.server.get_clients())
            if watched != bool(pages):
                watched = bool(pages)
                self.source.watch(watched)
            if pages:
                self._try_to_draw()
                due = max(due + 1 / (RATE if pages <= CROWD else CROWDED_RATE), time.monotonic())
                self._ending.wait(due - time.monotonic())
            else:  # the events of a node are taken, its samples are not
                self._follow()
                self._connected.wait(UNWATCHED)

    def _try_to_draw(self) -> None:
        """Draw a frame. After a bug the page says so, and the next frame may be drawn."""
        try:
            self._draw()
        except Exception as error:
            self.actions.message = f"drawing failed: {type(error).__name__}: {one_line(error)}"

    def _draw(self) -> None:
        """Draw a frame; what people read changes less often."""
        with self.server.atomic():
            self._follow()
            pull = self._pull
            self._scene.draw(self.run, pull[1] if pull else None)
            if self.frames % CHART_EVERY == 0:
                self._charts.draw(self.run)
            if self.frames % TEXT_EVERY == 0:
                self._charts.write(self.run)
                self._controls.write()
        self.server.flush()  # else viser waits for more, up to a sixtieth of a second
        self.frames += 1

    def _follow(self) -> list[Event]:
        """Take over what happened to the top; return the events."""
        events = self.run.follow(self.source.batch())
        for sentence in self.source.reports():
            self.actions.message = sentence
        if events and self.run.segment is not None:
            self._scene.begin_motion(self.run.segment, events[-1].state())
            self._charts.begin_motion(self.run)
            for event in events:
                self._controls.follow(event)
            self._controls.write()
        return events

    async def _drag(self, event: SceneNodeDragEvent[IcosphereHandle]) -> None:
        """Follow a pull at the axle, and kick the top at its end."""
        if event.phase != "end":
            self._pull = (event.client_id, np.array(event.end_position))
            return
        pull, self._pull = self._pull, None
        # The end of a drag is also reported when a page is closed in its middle: that is no kick.
        if pull and pull[0] == event.client_id in self.server.get_clients():
            self.server.get_event_loop().run_in_executor(None, self.actions.pull, pull[1])

    def _take_link(self, texts: dict[str, str]) -> None:
        threading.Thread(target=self.actions.follow_link, args=(texts,), daemon=True).start()
