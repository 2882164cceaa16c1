"""The page in each language: its words, its numbers, and room for them."""

import json

import pytest
from trials import choose

from symtop_ros.page.panel.main import main
from symtop_ros.page.web.join import LANGUAGES, TEXTS, read_texts
from workshop.languages import check_languages, compare_texts

PHONE = (360, 640)


def test_every_language_is_complete_and_the_command_names_each_fault(capsys):
    # That will never be a language.
    assert check_languages(["zz"]) == 1
    missing = ["zz: words/zz.json: is missing", "zz: texts/zz.json: is missing"]
    assert capsys.readouterr().out.splitlines() == missing
    assert check_languages(LANGUAGES) == 0
    assert capsys.readouterr().out == "complete\n"


@pytest.mark.parametrize(
    ("english", "text", "fault"),
    [
        ("{name} is {value:3f}", "{name} ist {value:2f}", "placeholder value3f is missing"),
        ("theta'' is 0.5 rad/s", "theta' ist 0,5 rad/s", "symbol theta'' is missing"),
        ("0.5 rad", "0,6 rad", "number 0.6 is not in the English text"),
        ("the [torque|torque] of {x}", "das Moment von {x}", "arrow torque is missing"),
        ("{x} s", "{x}lik s", "a number must have no suffix"),
        ("the axis", "l'axe", "an apostrophe must be U+2019: ' is a derivative"),
    ],
)
def test_a_fault_of_a_translation_is_found(english, text, fault):
    assert fault in list(compare_texts(english, text))
    assert list(compare_texts(english, english)) == []


# The narrowest window, and German, a third longer than English; the others in the long run.
@pytest.mark.slow
@pytest.mark.parametrize("language", choose(LANGUAGES, ("de",)))
@pytest.mark.parametrize("size", choose((PHONE, (1366, 768), (1920, 1080)), [PHONE]))
def test_nothing_is_cut_in_any_window(open_page, language, size):
    width, height = size
    window = {"viewport": {"width": width, "height": height}, "locale": language}
    page = open_page(known="", **window)
    page.wait_for_frames()
    assert page.tab.evaluate("looks.findCut") == []
    page.tab.click("[data-answer=rises]")
    page.until(lambda: page.tab.is_visible("#compared"))
    assert page.tab.evaluate("looks.findCut") == []
    page.follow("#lesson=3")
    page.open_charts()
    page.tab.locator("#lesson-predict:not(:empty)").wait_for()
    page.wait_for_frames(20)
    assert page.tab.evaluate("looks.findCut") == []
    for tab in ("start", "push", "view", "save"):
        page.open_tab(tab)
        assert page.tab.evaluate("looks.findCut") == [], tab


def is_in(page, language):
    texts = read_texts(language)
    found = (page.tab.get_attribute("html", "lang"), page.tab.title(), page.say("hurry"))
    return found == (language, texts["page.title"], texts["page.hurry"])


@pytest.mark.slow
def test_the_language_is_that_of_the_address_or_the_choice_or_the_browser(open_page):
    assert is_in(open_page(locale="de-AT"), "de")
    assert is_in(open_page(locale="ja-JP"), "en")
    page = open_page("#lang=de&theta=0.7")
    assert is_in(page, "de")
    assert page.read_last().euler_angles.theta == pytest.approx(0.7, rel=1e-15)
    page.follow("#lang=en")
    page.until(lambda: is_in(page, "en"))


@pytest.mark.slow
def test_a_chosen_language_stays_and_keeps_the_run(open_page, tmp_path):
    page = open_page()
    page.tab.click("#hurry")
    page.wait_for_time(0.02)
    page.tab.click("#pause")
    run = page.read_run()
    page.open_tab("view")
    with page.tab.expect_navigation():
        page.tab.select_option("#language", "de")
    page.wait_for_page()
    assert is_in(page, "de")
    assert page.read_events() == run["events"]
    assert "rad höher als ohne den Schub" in page.say("headline")
    page.reload()
    assert is_in(page, "de")
    saved = page.save("Dieser Lauf als Seite", tmp_path)
    other = open_page(file=saved)
    assert is_in(other, "de")
    assert other.read_events() == run["events"]
    other.open_tab("view")
    with other.tab.expect_navigation():
        other.tab.select_option("#language", "en")
    other.wait_for_page()
    assert is_in(other, "en")


def test_numbers_have_a_decimal_comma_where_the_language_has_one(open_page):
    page = open_page("#lang=de")
    page.press("Space")  # else the field shows another tilt at once
    page.enter("theta", "0,625")
    assert page.read_last().euler_angles.theta == pytest.approx(0.625, rel=1e-15)
    page.tab.locator("#field-theta").blur()
    page.until(lambda: page.tab.input_value("#field-theta") == "0,625")
    page.enter("theta", "9,5")
    assert page.say("refusal").endswith("eingegeben: 9,5")
    page.open_charts("theta")
    page.until(lambda: "," in page.tab.inner_text("#theta"))
    assert "." not in page.tab.inner_text("#theta").replace("θ", "")
    assert "," in page.tab.inner_text("#clock")


def test_the_program_writes_the_page_in_a_language_of_its_own(open_page, tmp_path, capsys):
    path = tmp_path / "seite.html"
    assert main(["--language", "de", "--write", str(path)]) == 0
    assert is_in(open_page(file=path), "de")
    with pytest.raises(SystemExit) as ended:
        main(["--language", "xx"])
    assert ended.value.code == 2
    assert "--language" in capsys.readouterr().err


def test_the_file_of_a_language_is_sorted_as_the_english_one():
    """A translator compares two files line by line; the scenes are at the end."""
    texts = {each: (TEXTS / f"{each}.json").read_text("utf-8") for each in LANGUAGES}
    keys = {each: [*json.loads(text)] for each, text in texts.items()}
    for language in LANGUAGES:
        assert keys[language][: len(keys["en"])] == keys["en"], language
