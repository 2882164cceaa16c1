"""The page's modules in a browser: a tab in which each can be imported."""

import base64
from pathlib import Path

from symtop_ros.web.join import read_texts

FOLDER = Path(__file__).parents[2] / "symtop_ros/web"
SITE = "http://top.test/"


def open_tab(browser):
    """Return a tab of a site that has the modules and the kernel, and nothing else."""
    tab = browser.new_page()
    tab.route("**/*", _answer)
    tab.goto(SITE)
    return tab


def _answer(route):
    name = route.request.url.removeprefix(SITE)
    if not name:
        route.fulfill(body="<!doctype html><title>modules</title>", content_type="text/html")
    elif (path := FOLDER / "js" / name).is_file():
        route.fulfill(body=path.read_text(), content_type="text/javascript")
    else:
        route.fulfill(status=404)


def load_kernel(tab):
    """Have the tab keep the kernel and the English texts as `kernel` and `phrase`."""
    arguments = [
        base64.b64encode((FOLDER / "kernel.wasm").read_bytes()).decode(),
        read_texts("en"),
    ]
    tab.evaluate(
        """async ([module, templates]) => {
            const { Kernel } = await import("/physics/kernel.js");
            const { phrase, setTemplates } = await import("/words/wording.js");
            const decode = (text) => Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
            window.kernel = await Kernel.load(decode(module));
            setTemplates(templates);
            window.phrase = phrase;
        }""",
        arguments,
    )
