"""The link of a start: copied, and as a code that a camera reads."""

import io
from functools import partial

import pytest
import zxingcpp
from page.web.opened import FUNCTIONS, KNOWN, USUAL
from PIL import Image
from serving import serving
from waiting import until

from symtop_ros.page.web.join import write_file


@pytest.mark.slow
def test_the_link_of_a_start_is_copied(opened):
    opened.tab.evaluate("""() => {
        navigator.clipboard.writeText = async (text) => { window.copied = text; };
    }""")
    opened.open_tab("save")
    opened.tab.click("#copy-link")
    opened.until(lambda: opened.say("copy-link") == "Copied")
    assert opened.tab.evaluate("window.copied") == opened.tab.input_value("#link")
    opened.until(lambda: opened.say("copy-link") == "Copy the link")


def test_a_page_of_a_file_has_no_code_which_no_other_machine_could_open(opened):
    opened.open_tab("save")
    assert opened.tab.is_visible("#link")
    assert not opened.tab.is_visible("#code")


@pytest.mark.slow
def test_a_camera_reads_the_link_of_a_page_that_is_served(browser):
    context = browser.new_context(color_scheme="dark")
    context.add_init_script(FUNCTIONS + KNOWN + USUAL)
    tab = context.new_page()
    look = partial(tab.wait_for_timeout, 20)
    with serving(write_file()) as server:
        tab.goto(server.url)
        tab.locator("#headline:not(:empty)").wait_for()
        tab.click("#tab-save")
        for act in ("hurry", "delay"):
            before = tab.input_value("#link")
            tab.click(f"#doing [data-act={act}]")
            until(lambda: tab.input_value("#link") != before, look)  # noqa: B023
            until(lambda: read_code(tab) == tab.input_value("#link"), look)
            assert read_code(tab).startswith(f"{server.url}#")
    context.close()


def read_code(tab):
    """Return what a camera reads."""
    (code,) = zxingcpp.read_barcodes(Image.open(io.BytesIO(tab.locator("#code").screenshot())))
    return code.text
