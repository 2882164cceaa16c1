"""The page's modules in a browser: a tab in which each can be imported."""

import base64
from pathlib import Path

from symtop_ros.page.web.join import read_texts

FOLDER = Path(__file__).parents[3] / "symtop_ros/page/web"
SITE = "http://top.test/"


def open_tab(browser):
    """Return a tab of a site that has the modules and the kernel, and nothing else."""
    tab = browser.new_page()
    tab.route("**/*", _answer)
    tab.goto(SITE)
    tab.add_script_tag(content=Path(__file__).with_name("modules.js").read_text())
    return tab


def _answer(route):
    name = route.request.url.removeprefix(SITE)
    if not name:
        route.fulfill(body="<!doctype html><title>modules</title>", content_type="text/html")
    elif (path := FOLDER / "js" / name).is_file():
        route.fulfill(body=path.read_text(), content_type="text/javascript")
    else:
        route.fulfill(status=404)


def load_kernel(tab, language="en"):
    """Have the tab keep the kernel and the texts of a language as `kernel` and `phrase`."""
    kernel = base64.b64encode((FOLDER / "kernel.wasm").read_bytes()).decode()
    tab.evaluate("loadKernel", [kernel, read_texts(language), language])
