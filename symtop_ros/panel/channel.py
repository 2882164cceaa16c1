"""The channel between a page's controls and charts and this program: JSON over a WebSocket.

Each page is sent what is new since its last message. A message waits for the one before, so that a
slow page gets fewer messages and not old ones.
"""

import asyncio
import json
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from symtop_ros.panel.actions import Actions
from symtop_ros.simulation.presets import describe_scenes
from symtop_ros.simulation.validation import RefusedError, number, one_line, reject
from symtop_ros.web.facts import describe_constants, identify, list_history, round_row, thin
from symtop_ros.web.lesson import read_lesson
from symtop_ros.web.run import Run
from symtop_ros.web.scene import HIDDEN_LAYERS, LAYERS

LOG = "/log.mcap"  # where a page finds the log that was finished last
Message = Mapping[str, Any]


class Pages:
    """All pages that are open, by the names that they have given themselves."""

    def __init__(self, run: Run, actions: Actions, lock: threading.Lock) -> None:
        self.facts: dict[str, Any] = {}  # of the run, as the pages have them
        self.show: Callable[[str, str, bool], None] = lambda *_: None  # page, layer, shown
        self.wake: Callable[[], None] = lambda: None  # called when a page is opened
        self._run, self._actions, self._lock = run, actions, lock
        self._pages: dict[ServerConnection, asyncio.Event] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        self._notices: list[str] = []

    def __len__(self) -> int:
        return len(self._pages)

    def update(self) -> None:
        """Let all pages know that there is something new; from any thread."""
        if self._loop is not None and self._pages:
            self._loop.call_soon_threadsafe(self._wake)

    def notify(self, sentence: str) -> None:
        """Say something on all pages."""
        self._notices.append(sentence)
        self.update()

    async def serve(self, connection: ServerConnection, name: str) -> None:
        """Serve one page until it is closed."""
        self._loop = asyncio.get_running_loop()
        self._pages[connection] = asyncio.Event()
        self.wake()
        sending = asyncio.create_task(self._send(connection))
        try:
            async for text in connection:
                answer = await self._loop.run_in_executor(None, self._act, name, text)
                await connection.send(json.dumps(answer))
        except ConnectionClosed:
            pass
        finally:
            sending.cancel()
            del self._pages[connection]

    def _wake(self) -> None:
        for event in self._pages.values():
            event.set()

    async def _send(self, connection: ServerConnection) -> None:
        """Send what is new, each time that there is something."""
        scenes = [scene._asdict() for scene in describe_scenes()]
        steps = [asdict(step) for step in read_lesson()]
        layers = {layer: layer not in HIDDEN_LAYERS for layer in LAYERS}
        hello = {"scenes": scenes, "layers": layers, "lesson": steps}
        await connection.send(json.dumps({"hello": hello}))
        facts: dict[str, Any] = {}
        number, said, event = -1, len(self._notices), self._pages[connection]
        while True:
            with self._lock:
                message: dict[str, Any] = {}
                if self.facts and self.facts is not facts:
                    message["facts"] = facts = self.facts
                if facts:
                    number = self._add_rows(message, number)
            if len(self._notices) > said:
                message["said"], said = self._notices[-1], len(self._notices)
            if message:
                await connection.send(json.dumps(message))
            await event.wait()
            event.clear()

    def _add_rows(self, message: dict[str, Any], number: int) -> int:
        """Add the rows of the series from a number on; return the number of the next one."""
        run = self._run
        count, rows = run.series_since(max(number, 0))
        if not len(run.series()) or not (len(rows) or message):
            return count  # a paused top sends nothing
        shown = rows[rows[:, 0] >= max(run.time - run.window, self.facts["since"] - 1e-9)]
        if len(shown):
            message["rows"] = thin(shown, run.window)
        message["now"] = round_row(run.series()[-1])
        message["constants"] = describe_constants(run)
        return count

    def _act(self, page: str, text: str | bytes) -> dict[str, Any]:
        """Do what a page asks for; return the answer for this page.

        An unexpected exception is reported as what it is; it is no refusal.
        """
        try:
            return {"granted": True, **(self._do(page, _read_message(text)) or {})}
        except RefusedError as refusal:
            return {"refused": one_line(refusal)}
        except Exception as error:
            failure = f"a request failed: {type(error).__name__}: {one_line(error)}"
            print(f"top_panel: {failure}", file=sys.stderr)
            return {"said": failure}

    def _do(self, page: str, message: Message) -> dict[str, Any] | None:
        actions = self._actions
        acts: dict[str, Callable[[], Any]] = {
            "kick": lambda: actions.kick(_number(message, "factor"), message.get("hold")),
            "pause": actions.toggle_pause,
            "run": lambda: actions.request("pause", False),
            "rest": self._rest,
            "step": actions.step,
            "reset": lambda: actions.request("reset"),
            "record": self._record,
            "push": lambda: actions.push(str(message.get("way"))),
            "torque": lambda: actions.hold_torque(_number(message, "sign")),
            "speed": lambda: actions.set_parameters({"real_time_factor": message.get("factor")}),
            "set": lambda: actions.set_parameters({str(message.get("name")): message.get("value")}),
            "start": lambda: actions.start(_select(message)),
            "scene": lambda: actions.choose_scene(str(message.get("name"))),
            "link": lambda: actions.follow_link(_texts(message.get("link"))),
            "restart": lambda: self._restart(message.get("entry")),
            "show": lambda: self._show(page, message),
        }
        name = message.get("act")
        if name not in acts:
            raise reject("act", f"one of {', '.join(acts)}", name)
        result = acts[name]()
        return result if isinstance(result, dict) else None

    def _rest(self) -> None:
        """Pause for a page that prefers no motion, if no other page is open."""
        if len(self._pages) == 1:
            self._actions.rest()

    def _record(self) -> dict[str, Any]:
        answer, log = self._actions.switch_recording()
        return {"said": answer} if log is None else {"said": answer, "file": LOG}

    def _restart(self, entry: object) -> None:
        with self._lock:
            events = [event for event in list_history(self._run) if identify(event) == entry]
        if not events:
            raise reject("entry", "one of the history", entry)
        self._actions.restart_from(events[0])

    def _show(self, page: str, message: Message) -> None:
        if message.get("layer") not in LAYERS:
            raise reject("layer", f"one of {', '.join(LAYERS)}", message.get("layer"))
        self.show(page, str(message["layer"]), bool(message.get("shown")))


def _read_message(text: str | bytes) -> dict[str, Any]:
    """Return a message of a page; refuse what is no JSON object."""
    try:
        message = json.loads(text)
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError):
        raise reject("message", "JSON", text) from None
    if not isinstance(message, dict):
        raise reject("message", "an object", message)
    return message


def _number(message: Message, name: str) -> float:
    return number(name, message.get(name), "number")


def _select(message: Message) -> dict[str, Any]:
    return {name: value for name, value in message.items() if name != "act"}


def _texts(link: object) -> dict[str, str]:
    if not isinstance(link, dict):
        raise reject("link", "an object of texts", link)
    return {str(name): str(value) for name, value in link.items()}
