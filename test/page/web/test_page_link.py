"""The link of a start: copied, and as a code that a camera reads."""

import io

import pytest
import zxingcpp
from page.web.opened import FUNCTIONS, KNOWN, USUAL
from PIL import Image
from serving import serving

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
    with serving(write_file()) as server:
        tab.goto(server.url)
        tab.locator("#headline:not(:empty)").wait_for()
        tab.click("#tab-save")
        for act in ("hurry", "delay"):
            tab.click(f"#doing [data-act={act}]")
            tab.wait_for_timeout(100)
            picture = Image.open(io.BytesIO(tab.locator("#code").screenshot()))
            (code,) = zxingcpp.read_barcodes(picture)
            assert code.text == tab.input_value("#link")
            assert code.text.startswith(f"{server.url}#")
    context.close()
