"""The lesson on the page: a class presses through all steps."""

import re

import pytest
from by_hand import follow_by_hand
from page.web.opened import FEW_FRAMES, read_motion
from page.web.pdf_pages import read_pages, squeeze
from trials import choose

from symtop_ros.page.web.join import LANGUAGES, read_texts
from symtop_ros.physics import Top, regular_precession_rates
from workshop.lesson.steps import read_lesson

SECRET = "it falls, I think"
STEPS = read_lesson()
FICTITIOUS = "fictitious torques"
# Of each button in turn: the turning angles in rad to three digits.
ANGLES = (
    ((0.5, 0.664),),
    ((0.5, 0.664),),
    ((0.5, 0.907), (0.5, 0.559), (0.5, 0.664)),
    ((0.5, 0.5),),
    ((0.5, 0.5),),
    ((0.439, 0.5), (0.384, 0.5), (0.194, 0.5)),
    ((0.5, 0.587), (0.439, 0.5), (0.458, 0.558), (0.458, 0.558)),
    ((0.5, 0.5), (0.437, 0.5), (0.5, 0.5), (0.438, 0.5)),
    ((0.5, 0.5), (0.5, 0.810)),
    ((0.5, 0.5), (0.439, 0.5), (0.5, 0.5), (0.5, 0.528)),
    ((0.5, 0.5), (0.5, 0.544), (0.5, 0.5), (0.362, 0.5), (0.5, 0.5), (0.5, 0.8)),
    ((0.5, 0.664),),
    ((0.5, 0.5), (0.489, 0.5), (0.5, 0.5), (0.5, 0.506)),  # after the first push
    ((0.5, 0.5), (0.5, 3.142)),
    ((0.5, 0.694), (0.5, 0.694)),  # of the record
)


def list_names(page, selector):
    return page.tab.locator(selector).evaluate_all("all => all.map(e => e.dataset.chart)")


def name_event(act):
    if act.start or act.record:
        return "start"
    return "clamp" if act.clamp else "push" if act.push else "kick"


def press(page, act, turning):
    """Press a button of a step: its motion follows, and runs."""
    button = page.tab.get_by_role("button", name=act.button, exact=True)
    button.click()
    event = page.read_events()[-1]
    assert page.say("refusal") == ""
    assert page.say("why")
    assert event["kind"] == name_event(act)
    assert event["friction"] == [0, 0]
    # half of the last of three digits
    assert read_motion(event).turning_angles == pytest.approx(turning, abs=5e-4)
    assert page.say("pause") == ("Run" if act.record else "Pause")
    if not (act.start or act.record):
        assert button.is_disabled()


@pytest.mark.slow
def test_a_class_presses_through_all_steps(open_page):
    page = open_page("#lesson=1")
    for number, (step, expected) in enumerate(zip(STEPS, ANGLES, strict=True), start=1):
        assert page.tab.input_value("#steps") == f"{number}. {step.title}"
        # letters of formulas within sentences are marked: $u$
        assert page.say("lesson-predict").replace("$", "") == step.predict
        assert page.say("pause") == "Run"  # nothing moves before the prediction
        page.tab.fill("#prediction", f"{SECRET} {number}")
        for name in ("seen", "answer"):
            assert not page.tab.is_visible(f"#lesson-{name}")
        for act, turning in zip(step.acts, expected, strict=True):
            press(page, act, turning)
        box = page.tab.get_by_label(FICTITIOUS)
        assert box.is_checked() is (FICTITIOUS in step.layers)
        assert sorted(list_names(page, ".looked [data-chart]")) == sorted(step.charts)
        for chart in page.tab.locator(".looked").all():
            assert 0 <= chart.bounding_box()["y"] < 720 / 2
        for summary, name in (("What happens", "seen"), ("Answer", "answer")):
            page.tab.get_by_text(summary, exact=True).click()
            assert page.tab.is_visible(f"#lesson-{name}")
        if number < len(STEPS):
            page.tab.click("#step-next")
    assert page.tab.is_disabled("#step-next")
    page.reload()
    assert page.tab.input_value("#prediction") == f"{SECRET} {len(STEPS)}"
    page.tab.click("#step-back")
    assert page.tab.input_value("#prediction") == f"{SECRET} {len(STEPS) - 1}"


def test_a_keyboard_does_a_step_on_a_phone(open_page):
    page = open_page("#lesson=8", viewport={"width": 390, "height": 844})
    page.tab.focus("#prediction")
    page.tab.keyboard.type("h s r ")  # letters of the prediction are no commands
    assert page.tab.input_value("#prediction") == "h s r "
    assert page.say("pause") == "Run"
    for _ in range(2):
        page.tab.keyboard.press("Tab")
        page.tab.keyboard.press("Enter")
    smallest, _ = read_motion(page.read_events()[-1]).turning_angles
    assert smallest == pytest.approx(0.437, abs=5e-4)
    page.tab.focus("#step-next")
    page.tab.keyboard.press("Space")
    assert page.tab.evaluate("document.activeElement.id") == "steps"
    assert page.say("lesson-predict") == STEPS[8].predict
    assert page.tab.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.slow
def test_predictions_are_kept_for_the_browser(open_page):
    page = open_page("#lesson=2")
    page.tab.fill("#prediction", "it falls")
    another = page.context.new_page()  # of the same browser
    another.goto(page.tab.url)
    page.until(lambda: page.is_stored("predictions", "it falls", another))
    another.reload()
    another.wait_for_selector("#headline:not(:empty)")
    assert another.input_value("#prediction") == "it falls"
    another.evaluate("localStorage.setItem('symtop.predictions', '{')")
    another.reload()
    another.wait_for_selector("#headline:not(:empty)")
    assert another.input_value("#prediction") == ""


@pytest.mark.slow
def test_after_a_reset_or_a_reload_the_hurry_of_the_step_works_again(open_page):
    page = open_page("#lesson=8")
    start, hurry = page.tab.locator("#lesson-acts button").all()[:2]
    assert hurry.is_disabled()
    start.click()
    hurry.click()
    assert hurry.is_disabled()  # a second one would not be that of the step
    page.tab.click("text=Reset")
    page.reload()
    hurry.click()
    assert "higher" in page.say("headline")
    page.enter("theta", "1")  # another motion, for which the step has no words
    page.open_tab("lesson")
    assert hurry.is_disabled()


@pytest.mark.slow
@pytest.mark.parametrize(("number", "near", "far"), [(3, "0.664", "0.66"), (13, ".392", "0.376")])
def test_a_number_that_is_asked_for_is_checked(open_page, number, near, far):
    page, ask = open_page(f"#lesson={number}"), STEPS[number - 1].ask
    field = page.tab.locator("#predicted-number")
    answers = {}
    for typed in (near, far, "deep", ""):
        field.fill(typed)
        field.press("Enter")
        answers[typed] = page.say("lesson-checked")
    assert answers[near] == f"Right, within {ask['within']:g} rad."
    assert answers[far] == f"Not within {ask['within']:g} rad. Try again."
    assert [answers["deep"], answers[""]] == ["Write a number.", ""]
    field.fill(near)
    field.blur()
    page.tab.click("#step-next")  # which asks for no number
    assert not field.is_visible()
    assert page.say("lesson-checked") == ""


@pytest.mark.wording
def test_a_number_is_asked_for_in_the_unit_of_the_page_and_may_have_a_comma(open_page):
    page = open_page("#lesson=13&lang=de")
    page.choose_unit("deg")
    page.open_tab("lesson")
    page.tab.fill("#predicted-number", "22,35")
    page.tab.press("#predicted-number", "Enter")
    assert page.say("lesson-checked") == "Richtig, auf 0,286° genau."


def test_the_table_of_a_step_is_behind_its_explanation(open_page):
    page, table = open_page("#lesson=3"), STEPS[2].table
    assert not page.tab.is_visible("#lesson-table")
    page.tab.get_by_text("What happens", exact=True).click()
    rows = page.tab.locator("#lesson-table tr").all()
    cells = [
        row.locator("th, td").evaluate_all("all => all.map(e => e.dataset.text)") for row in rows
    ]
    assert cells == [[*table.headings], *table.cells]
    page.tab.click("#step-next")
    assert page.tab.locator("#lesson-table tr").count() == 0


@pytest.mark.wording
def test_back_is_the_step_before_and_predictions_are_saved_as_a_text(open_page, tmp_path):
    page = open_page("#lesson=2")
    page.tab.fill("#prediction", "It falls.")
    page.tab.click("#step-next")
    assert page.tab.input_value("#steps").startswith("3.")
    page.tab.go_back()
    page.until(lambda: page.tab.input_value("#steps").startswith("2."))
    assert page.tab.input_value("#prediction") == "It falls."
    text = f"The first question: it rises\n2. {STEPS[1].title}: It falls.\n"
    assert page.save("My predictions", tmp_path).read_text() == text


NO_PRINTER = "window.print = () => {};"  # a separate window waits for its user
MOST_PAGES = -(-len(STEPS) // 2)  # half a page for a step


def read_sheets(page):
    """The texts of the paragraphs on paper."""
    return page.tab.locator("#sheets [data-text]").evaluate_all(
        "all => all.map(e => e.dataset.text)"
    )


@pytest.mark.slow
@pytest.mark.parametrize("language", choose(LANGUAGES, ("de",)))
def test_the_sheets_are_those_of_the_page_and_only_the_teacher_has_answers(open_page, language):
    page = open_page(f"#lang={language}", script=NO_PRINTER + FEW_FRAMES)
    texts = read_texts(language)
    page.open_tab("lesson")
    page.tab.fill("#prediction", SECRET)
    run = page.read_run()
    for kind in ("worksheet", "teacher"):
        page.tab.click(f"#print-{kind}")
        written = "\n\n".join(read_sheets(page))
        for step in STEPS:
            for part in ("title", "predict", "question", "seen", "answer"):
                is_there = kind == "teacher" or part not in ("seen", "answer")
                assert (texts[f"lesson.{step.name}.{part}"] in written) == is_there
        assert page.tab.locator("#sheets canvas").count() == (
            len(STEPS) if kind == "teacher" else 0
        )
        assert page.tab.locator("#sheets math").count() > 50
        given = page.tab.locator("#sheets .given").all_text_contents()
        assert given == ([SECRET] if kind == "worksheet" else [])
        pages = page.tab.pdf(prefer_css_page_size=True)
        assert 1 < len(re.findall(rb"/Type\s*/Page\b", pages)) <= MOST_PAGES
        page.tab.evaluate("dispatchEvent(new Event('afterprint'))")
        assert read_sheets(page) == []
    assert page.read_events() == run["events"]
    page.tab.click("#hurry")  # the page keeps running
    assert len(page.read_events()) == len(run["events"]) + 1


@pytest.mark.slow
def test_the_timeline_marks_the_acts_since_the_last_start_and_older_ones_when_asked(open_page):
    page = open_page("#lesson=9")
    button = page.tab.locator("#lesson-acts button").first
    for k in range(3):
        button.click()
        page.wait_for_time(0.1 * (k + 1))
    page.tab.click("#hurry")
    page.press("Space")
    page.wait_for_frames()
    count = page.tab.locator("#marks i").count
    assert count() == 2
    kept = len(page.read_events())
    assert page.tab.inner_text("#older") == f"+{kept - 2}"
    page.tab.click("#older")
    page.wait_for_frames()
    assert count() == kept
    page.tab.click("#older")
    page.wait_for_frames()
    assert count() == 2


def test_the_title_of_a_step_that_its_list_cuts_is_read_below(open_page):
    page = open_page("#lesson=10", locale="tr")
    title = page.tab.locator("#lesson-title")
    assert page.tab.input_value("#steps").endswith(title.inner_text())
    assert title.evaluate("each => each.scrollWidth <= each.clientWidth")


@pytest.mark.slow
def test_letters_of_a_sentence_about_a_formula_are_set_as_in_it(open_page):
    for language in ("en", "de", "es", "fr", "tr"):
        page = open_page("#lesson=3", locale=language)
        letters = page.tab.locator("#lesson-compute math").all_text_contents()
        assert "u" in [each.strip(".,") for each in letters]
        assert "$" not in page.tab.inner_text("#lesson")


# What is written on a picture: the box of each text in it, as shares of its width and height.
WRITTEN = """() => {
  window.print = () => {};
  const found = [];
  const { fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const { width, actualBoundingBoxAscent: up, actualBoundingBoxDescent: down } =
      this.measureText(text);
    const { a, d, e, f } = this.getTransform();
    found.push([this.canvas, text, a * x + e, d * (y - up) + f, a * (x + width) + e,
      d * (y + down) + f]);
    return fillText.call(this, text, x, y);
  };
  document.querySelector("#print-teacher").click();
  CanvasRenderingContext2D.prototype.fillText = fillText;
  const [{ width, height }] = document.querySelectorAll("#sheets canvas");
  const canvases = [...new Set(found.map(([canvas]) => canvas))];
  return canvases.map((own) => found.filter(([canvas]) => canvas === own).map(
    ([canvas, text, left, up, right, down]) => {
      const begin = (canvas.width - width) / 2;
      return [text, (left - begin) / width, up / height, (right - begin) / width, down / height];
    }));
}"""


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("size", [(1280, 720), (390, 844)])
def test_labels_of_printed_pictures_are_inside_and_apart(open_page, language, size):
    page = open_page(locale=language, viewport={"width": size[0], "height": size[1]})
    pictures = page.tab.evaluate(WRITTEN)
    assert len(pictures) > 5
    assert max(map(len, pictures)) >= 3
    for labels in pictures:
        for k, (text, left, up, right, down) in enumerate(labels):
            assert min(left, up) >= 0, text
            assert max(right, down) <= 1, text
            for other, its_left, its_up, its_right, its_down in labels[:k]:
                is_beside = right <= its_left or its_right <= left
                assert is_beside or down <= its_up or its_down <= up, (text, other)


MARGIN = 12 / 25.4 * 72  # points of a sheet's edge
PLAIN = re.compile(r"[^'_<>=^*/|\[\]]+")  # a text without formulas and arrows


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("size", choose([(1280, 720), (390, 844)], [(1280, 720)]))
def test_the_words_of_a_printed_sheet_are_on_its_pages_and_beside_its_pictures(
    open_page, language, size
):
    window = {"viewport": {"width": size[0], "height": size[1]}}
    page = open_page(f"#lang={language}", script=NO_PRINTER + FEW_FRAMES, **window)
    page.tab.evaluate("document.querySelector('#print-teacher').click()")
    pages = read_pages(page.tab.pdf(prefer_css_page_size=True))
    written = "".join(each.text for each in pages)
    texts = read_texts(language)
    for step in STEPS:
        title = texts[f"lesson.{step.name}.title"]
        for part in PLAIN.findall(title):
            assert squeeze(part) in written
    assert sum(len(each.pictures) for each in pages) == len(STEPS)
    for each in pages:
        width, height = each.size
        for text, x, y in each.letters:
            assert MARGIN - 1 <= x <= width - MARGIN, text
            assert MARGIN - 1 <= y <= height - MARGIN, text
            for corners in each.pictures:
                (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
                assert not (left < x < right and low < y < high), text


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_numbers_by_hand_of_step_13_are_those_of_who_follows_the_sheet(language):
    text = read_texts(language)["lesson.pushes.seen"].replace(",", ".")
    slow, fast = regular_precession_rates(Top(0.000228, 0.0000572, 0.068), 0.5, 200.0)
    spin, before, rounds = follow_by_hand(slow)
    told = [f"p_psi = {spin:.5f}", f"p_phi = {before:.5f}"]
    told += [part for added, tilt in rounds for part in (f"{added:.6f} N m s", f"{tilt:.4f} rad")]
    told.append(f"{follow_by_hand(fast)[2][1][1]:.3f} rad")
    places = [text.find(each) for each in told]
    assert min(places) > 0, told
    assert places == sorted(places)
