"""The page for people on phones, with zoom, with a keyboard or a screen reader, in the dark."""

import pytest


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_there_is_no_finding_of_axe(open_page, scheme):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    page = open_page(color_scheme=scheme)
    for name in ("start", "push", "history", "view", "save", "lesson"):
        page.tab.click(f"#tab-{name}")
        found = axe.run(page.tab).response["violations"]
        assert [(each["id"], [n["html"][:120] for n in each["nodes"]]) for each in found] == []
