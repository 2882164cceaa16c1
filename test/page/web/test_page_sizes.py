"""The page in windows of laptops, tablets and phones, and with zoom."""

import pytest
from trials import choose

LONGEST_HEADLINE = (
    "Friction and a torque act. Without them, the top precesses in cusps and comes to rest at each."
)
# A laptop, a tablet held upright, a phone; a laptop with a zoom of 200 % and of 400 %.
WINDOWS = ((1280, 720), (820, 1180), (390, 844), (640, 360), (600, 500), (320, 230))
OFTEN = (WINDOWS[0], WINDOWS[2], WINDOWS[5])


def find_box(page, name):
    return page.tab.locator(name).bounding_box()


def scroll_to(page, name):
    """Return the box of a part after scrolling to it; what is drawn later may move it again."""
    page.tab.locator(name).scroll_into_view_if_needed()
    return find_box(page, name)


def settle(page, name):
    """Return the box of a part when it is the same twice: texts that arrive move what follows."""
    boxes = [find_box(page, name)]

    def is_still():
        boxes.append(find_box(page, name))
        return boxes[-1] == boxes[-2]

    page.until(is_still)
    return boxes[-1]


def is_inside(box, size):
    """Return True if a box is inside of a window; a part that is hidden has no box."""
    if box is None:
        return False
    right, bottom = box["x"] + box["width"], box["y"] + box["height"]
    return min(box["x"], box["y"]) >= 0 and right <= size[0] + 0.5 and bottom <= size[1] + 0.5


def is_large(box, least):
    return box is not None and min(box["width"], box["height"]) > least


def is_in_sight(box, size):
    return box is not None and box["y"] < size[1] and box["width"] > 150


@pytest.mark.slow
@pytest.mark.parametrize("size", choose(WINDOWS, OFTEN))
def test_in_any_window_hurry_is_in_reach_and_a_refusal_in_sight(open_page, size):
    width, height = size
    page = open_page(viewport={"width": width, "height": height})
    before = settle(page, "#scene")
    page.tab.evaluate(
        "(text) => { document.querySelector('#headline').textContent = text; }", LONGEST_HEADLINE
    )
    if size != (320, 230):  # there the page scrolls as one column
        assert find_box(page, "#scene") == before
    legend = settle(page, "#legend")
    assert legend is None or legend["height"] < 0.25 * before["height"]
    page.open_charts()
    hurry = settle(page, "#hurry")
    assert is_inside(hurry, size)
    page.until(lambda: is_large(find_box(page, "#picture"), 0.25 * min(size)))
    page.until(lambda: page.tab.evaluate("document.documentElement.scrollWidth") <= width)
    for name in ("#psi_dot", "#constants"):
        page.until(lambda name=name: is_in_sight(scroll_to(page, name), size))
    page.until(lambda: abs(find_box(page, "#hurry")["y"] - hurry["y"]) <= 1)  # stays in reach
    for name in ("Delay by a push", "Pause", "Step", "Reset"):
        page.tab.get_by_role("button", name=name, exact=True).scroll_into_view_if_needed()
    page.enter("theta", "9")
    page.until(lambda: is_inside(find_box(page, "#refusal"), size))
    page.until(lambda: page.tab.evaluate("looks.isOnTop", "refusal"))
    page.tab.keyboard.press("Escape")
    page.tab.locator("#refusal").wait_for(state="hidden")


@pytest.mark.slow
def test_labels_do_not_cover_each_other(open_page):
    page = open_page("#lesson=10")
    page.tab.locator("#lesson-acts button").first.click()
    page.tab.locator("#lesson-acts button").nth(1).click()
    page.tab.click("#pause")
    for _ in range(5):
        page.tab.click("text=Step")
        page.wait_for_frames()
        boxes = [each.bounding_box() for each in page.tab.locator(".label:visible").all()]
        assert len(boxes) >= 3
        for k, a in enumerate(boxes):
            for b in boxes[:k]:
                apart_x = max(a["x"], b["x"]) - min(a["x"] + a["width"], b["x"] + b["width"])
                apart_y = max(a["y"], b["y"]) - min(a["y"] + a["height"], b["y"] + b["height"])
                assert apart_x >= -1 or apart_y >= -1


def test_at_a_zoom_of_200_percent_the_scene_has_a_third_of_the_height_and_more(open_page):
    page = open_page(viewport={"width": 640, "height": 360})
    assert settle(page, "#scene")["height"] >= 170
