"""Firefox and WebKit on a screen in memory, by their own drivers."""

import base64
import contextlib
import json
import os
import shutil
import socket
import subprocess
import tempfile
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import waiting
from programs import running

TIMEOUT = 120.0  # s; ends a test that hangs, and is never waited for
STUMBLE = 0.05  # s
HELP = "sh test/get_browsers.sh, as root"
# The scene is drawn by software, and Firefox makes no request.
ON = ("webgl.force-enabled", "gfx.webrender.software", "security.fileuri.strict_origin_policy")
OFF = ("webgl.disabled", "browser.shell.checkDefaultBrowser", "app.update.enabled")
OFF += ("datareporting.policy.dataSubmissionEnabled", "network.captive-portal-service.enabled")
FIREFOX_PREFERENCES = dict.fromkeys(ON, True) | dict.fromkeys(OFF, False)


def until(driver: Any, condition: str) -> None:
    """Wait until an expression is true in the page."""
    waiting.until(lambda: driver.run(f"return Boolean({condition});"), timeout=TIMEOUT)


def find_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


# A driver gives an asynchronous script a function as its last argument, which takes its value.
WRAPPED = """
const [text, values, done] = arguments;
const answer = (value) => done([true, value === undefined ? null : value]);
const fail = (error) => done([false, String(error)]);
SCRIPT(...values).then(answer, fail);
"""


def wrap(script: str) -> str:
    function = f"(async (...given) => {{ {script} }})"
    return WRAPPED.replace("SCRIPT", function)


def unwrap(answer: Any) -> Any:
    succeeded, value = answer
    assert succeeded, value
    return value


class Firefox:
    """Firefox, by Marionette."""

    def __init__(self, client: Any, process: int) -> None:
        self.client, self.process = client, process

    def open(self, url: str) -> None:
        self.client.navigate(url)

    def run(self, script: str, *arguments: Any) -> Any:
        arguments_ = [script, list(arguments)]
        answer = self.client.execute_async_script(
            wrap(script), script_args=arguments_, sandbox=None, script_timeout=int(1000 * TIMEOUT)
        )
        return unwrap(answer)

    def press(self, key: str) -> None:
        """Press a key, as a person does."""
        self.client.actions.sequence("key", "keys").key_down(key).key_up(key).perform()

    def resize(self, width: int, height: int) -> None:
        """Give the page a size in px, as far as the window can be so narrow."""
        self.client.set_window_rect(width=width, height=height)
        own = self.run("return [innerWidth, innerHeight];")
        self.client.set_window_rect(width=2 * width - own[0], height=2 * height - own[1])

    def take_picture(self) -> bytes:
        """Return the window as PNG."""
        return base64.b64decode(self.client.screenshot(full=False))

    def reload(self) -> None:
        self.client.refresh()


@contextlib.contextmanager
def running_firefox(**others: Any) -> Iterator[Any]:
    """Run Firefox, with other preferences as well; the test is skipped without it."""
    module = pytest.importorskip("marionette_driver.marionette", reason=f"no Marionette: {HELP}")
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    if not program or not shutil.which("Xvfb"):
        pytest.skip(f"no Firefox: {HELP}")
    port = find_port()
    with tempfile.TemporaryDirectory() as profile:
        preferences = {**FIREFOX_PREFERENCES, "marionette.port": port, **others}
        lines = [f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in preferences.items()]
        Path(profile, "user.js").write_text("\n".join(lines))
        command = [program, "--marionette", "--no-remote", "--profile", profile]
        with (
            running_screen() as screen,
            running(command, 0, **silent({**screen, "HOME": profile})) as process,
        ):
            wait_for_port(port)
            client = module.Marionette(host="127.0.0.1", port=port)
            client.start_session()
            client.timeout.script = TIMEOUT
            try:
                yield Firefox(client, process.pid)
            finally:
                client.delete_session()


class WebKit:
    """WebKit's MiniBrowser, by the protocol of WebDriver."""

    def __init__(self, port: int, process: int) -> None:
        self.process = process
        self.address = f"http://127.0.0.1:{port}/session"
        binary = next(Path("/usr/lib").glob("*/webkit2gtk-4.*/MiniBrowser"))
        options = {"binary": str(binary), "args": ["--automation"]}
        wanted = {"alwaysMatch": {"webkitgtk:browserOptions": options}}
        self.address += "/" + self.ask("", {"capabilities": wanted})["sessionId"]
        self.ask("/timeouts", {"script": int(1000 * TIMEOUT), "pageLoad": int(1000 * TIMEOUT)})

    def ask(self, path: str, body: Any, method: str = "POST") -> Any:
        data = json.dumps(body).encode() if method == "POST" else None
        request = urllib.request.Request(self.address + path, data, method=method)
        request.add_header("Content-Type", "application/json")
        with urllib.request.urlopen(request, timeout=TIMEOUT) as answer:
            return json.load(answer)["value"]

    def open(self, url: str) -> None:
        self.ask("/url", {"url": url})

    def run(self, script: str, *arguments: Any) -> Any:
        body = {"script": wrap(script), "args": [script, list(arguments)]}
        return unwrap(self.ask("/execute/async", body))

    def press(self, key: str) -> None:
        """Press a key, as a person does."""
        presses = [{"type": name, "value": key} for name in ("keyDown", "keyUp")]
        self.ask("/actions", {"actions": [{"type": "key", "id": "keys", "actions": presses}]})

    def reload(self) -> None:
        self.ask("/refresh", {})

    def resize(self, width: int, height: int) -> None:
        """Give the page a size in px, as far as the window can be so narrow."""
        self.ask("/window/rect", {"width": width, "height": height})
        own = self.run("return [innerWidth, innerHeight];")
        self.ask("/window/rect", {"width": 2 * width - own[0], "height": 2 * height - own[1]})

    def take_picture(self) -> bytes:
        """Return the window as PNG."""
        return base64.b64decode(self.ask("/screenshot", None, "GET"))

    def close(self) -> None:
        self.ask("", None, "DELETE")


@contextlib.contextmanager
def running_webkit() -> Iterator[Any]:
    """Run WebKit; the test is skipped without it."""
    if not shutil.which("WebKitWebDriver") or not shutil.which("Xvfb"):
        pytest.skip(f"no WebKit: {HELP}")
    port = find_port()
    driver_command = ["WebKitWebDriver", f"--port={port}"]
    with running_screen() as screen, running(driver_command, 0, **silent(screen)) as process:
        wait_for_port(port)
        driver = WebKit(port, process.pid)
        try:
            yield driver
        finally:
            driver.close()


@contextlib.contextmanager
def stumbling(driver: Any) -> Iterator[None]:
    """Stop the processes of a browser every 50 ms for 50 ms, as next to other programs."""
    psutil = pytest.importorskip("psutil", reason="no psutil: pip install -e '.[test]'")
    own = psutil.Process(driver.process)
    ended = threading.Event()

    def stumble() -> None:
        while not ended.wait(STUMBLE):
            all_ = [own, *own.children(recursive=True)]
            for act in (psutil.Process.suspend, psutil.Process.resume):
                for each in all_:
                    with contextlib.suppress(psutil.NoSuchProcess):
                        act(each)
                ended.wait(STUMBLE)

    thread = threading.Thread(target=stumble)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def silent(variables: dict[str, str]) -> dict[str, Any]:
    """Options of a program whose output is not read."""
    nothing = subprocess.DEVNULL
    return {"env": {**os.environ, **variables}, "stdout": nothing, "stderr": nothing}


@contextlib.contextmanager
def running_screen() -> Iterator[dict[str, str]]:
    """Run a screen in memory; yield the environment of programs on it."""
    screen = f":{find_port()}"
    command = ["Xvfb", screen, "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    with running(command, 0, **silent({})):
        yield {"DISPLAY": screen, "LIBGL_ALWAYS_SOFTWARE": "1", "GDK_BACKEND": "x11"}


def wait_for_port(port: int) -> None:
    """Wait until a program listens."""

    def listens() -> bool:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
            return True
        return False

    waiting.until(listens, timeout=TIMEOUT)
