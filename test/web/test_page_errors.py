"""The page keeps working: errors of a part, refused acts, and a late or early frame."""

from web.opened import FEW_FRAMES, UNDRAWN, USUAL


def test_frames_with_old_stamps_do_not_run_the_time_backwards(open_page):
    opened = open_page(script="patches.ageStamps();" + UNDRAWN)
    opened.tab.click("#hurry")
    opened.wait_for_time(0.01)
    start, kick = opened.read_events()
    assert (start["kind"], start["time"], kick["kind"]) == ("start", 0, "kick")
    assert kick["time"] >= 0


def test_an_error_in_a_part_is_shown_once_and_costs_only_this_part(open_page):
    broken = "WebGL2RenderingContext.prototype.drawArrays = () => { throw new Error('no card'); };"
    opened = open_page(script=FEW_FRAMES + broken)
    opened.until(lambda: opened.say("refusal"))
    failed = "scene: this failed because of a bug in the page: no card"
    assert opened.say("refusal").startswith(failed)
    opened.press("h")
    opened.wait_for_time(0.05)
    assert opened.say("refusal") == ""
    assert "higher" in opened.say("headline")
    assert [each.splitlines()[0] for each in opened.problems] == ["Error: no card"]
    opened.problems.clear()


def test_a_stored_choice_of_another_version_is_dropped(open_page):
    stored = (
        "localStorage.setItem('symtop.free-x', 'speed'); localStorage.setItem('symtop.unit', '');"
    )
    opened = open_page(script=stored + USUAL)
    assert opened.tab.input_value("#free-x") == "theta"
    assert opened.tab.input_value("#unit") == "deg"
    opened.wait_for_time(0.02)


def test_a_spin_beyond_what_can_be_computed_waits_and_says_so(opened):
    for rate in ("1e20", "-1e99"):
        opened.enter("psi_dot", rate)
        opened.until(lambda: opened.say("refusal"))
        assert opened.say("refusal") == "times must be within 1e15 turns of the start"
        assert opened.say("pause") == "Run"
        opened.enter("psi_dot", "200")
        opened.press("Space")
        opened.wait_for_time(opened.read_events()[-1]["time"] + 0.01)
        assert opened.say("refusal") == ""
