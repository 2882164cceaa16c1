"""The lesson on the page."""

from symtop_ros.web.lesson import read_lesson


def test_each_button_of_the_lesson_makes_its_motion(open_page):
    page = open_page("#lesson=1")
    for number, step in enumerate(read_lesson(), 1):
        assert page.tab.input_value("#steps") == f"{number}. {step.title}"
        for button in page.tab.locator("#lesson-acts button").all():
            before = page.say("why")
            button.click()
            assert page.say("refusal") == ""
            assert page.say("why")
            assert page.say("why") != before or "hold" not in button.text_content()
        if number < len(read_lesson()):
            page.tab.click("#step-next")


def test_back_is_the_step_before(open_page):
    page = open_page("#lesson=2")
    page.tab.fill("#prediction", "it falls")
    page.tab.click("#step-next")
    assert page.tab.input_value("#steps").startswith("3.")
    page.tab.go_back()
    page.until(lambda: page.tab.input_value("#steps").startswith("2."))
    assert page.tab.input_value("#prediction") == "it falls"
