"""The page in windows of laptops, tablets and phones, and with zoom."""

import pytest

# A laptop, a tablet held upright, a phone; a laptop with a zoom of 200 % and of 400 %.
WINDOWS = ((1280, 720), (820, 1180), (390, 844), (640, 360), (600, 500), (320, 230))


def open_in(open_page, size, **options):
    width, height = size
    return open_page(viewport={"width": width, "height": height}, **options)


def find_box(page, name):
    return page.tab.locator(name).bounding_box()


def is_inside(box, size):
    width, height = size
    return (
        box["x"] >= 0
        and box["y"] >= 0
        and box["x"] + box["width"] <= width + 0.5
        and box["y"] + box["height"] <= height + 0.5
    )


@pytest.mark.parametrize("size", WINDOWS)
def test_hurry_is_in_the_window_and_the_scene_and_charts_in_reach(open_page, size):
    page = open_in(open_page, size)
    hurry = find_box(page, "#hurry")
    assert is_inside(hurry, size)
    scene = find_box(page, "canvas")
    assert min(scene["width"], scene["height"]) > 0.25 * min(size)
    assert page.tab.evaluate("document.documentElement.scrollWidth") <= size[0]
    for name in ("#psi_dot", "#constants"):
        page.tab.locator(name).scroll_into_view_if_needed()
        box = find_box(page, name)
        assert box["y"] < size[1]
        assert box["width"] > 150
    assert find_box(page, "#hurry")["y"] == pytest.approx(hurry["y"], abs=1)  # stays in reach
    for name in ("Delay", "Pause", "Step", "Reset"):
        page.tab.get_by_role("button", name=name, exact=True).scroll_into_view_if_needed()


@pytest.mark.parametrize("size", WINDOWS)
def test_a_refusal_is_in_sight_and_escape_puts_it_away(open_page, size):
    page = open_in(open_page, size)
    page.enter("theta", "9")
    refusal = page.tab.locator("#refusal")
    assert is_inside(refusal.bounding_box(), size)
    assert page.tab.evaluate(
        """() => {
            const notice = document.getElementById("refusal");
            const { left, top, width, height } = notice.getBoundingClientRect();
            const above = document.elementFromPoint(left + width / 2, top + height / 2);
            return notice.contains(above);
        }"""
    )
    page.tab.keyboard.press("Escape")
    assert not refusal.is_visible()


@pytest.mark.parametrize("size", WINDOWS)
def test_no_headline_moves_the_scene_and_no_legend_covers_much_of_it(open_page, size):
    page = open_in(open_page, size)
    before = find_box(page, "#scene")
    words = "Friction and a torque act: without them the top falls and comes back to rest in cusps."
    page.tab.evaluate(
        "(text) => { document.querySelector('#headline').textContent = text; }", words
    )
    if size != (320, 230):  # there the page scrolls as one column
        assert find_box(page, "#scene") == before
    legend = find_box(page, "#legend")
    assert legend is None or legend["height"] < 0.25 * before["height"]


def test_labels_do_not_cover_each_other(open_page):
    page = open_page("#lesson=10")
    page.tab.locator("#lesson-acts button").first.click()
    page.tab.locator("#lesson-acts button").nth(1).click()
    page.tab.click("#pause")
    for _ in range(5):
        page.tab.click("text=Step")
        page.tab.wait_for_timeout(200)
        boxes = [each.bounding_box() for each in page.tab.locator(".label:visible").all()]
        assert len(boxes) >= 5
        for k, a in enumerate(boxes):
            for b in boxes[:k]:
                apart_x = max(a["x"], b["x"]) - min(a["x"] + a["width"], b["x"] + b["width"])
                apart_y = max(a["y"], b["y"]) - min(a["y"] + a["height"], b["y"] + b["height"])
                assert apart_x >= -1 or apart_y >= -1
