"""Requests of a page: what is refused, and what is a bug."""

import json
import threading

import pytest

from symtop_ros.panel.actions import Actions
from symtop_ros.panel.channel import Pages
from symtop_ros.panel.source import LocalTop
from symtop_ros.web.run import Run


@pytest.fixture(name="pages")
def _pages():
    top, run = LocalTop("hurry_slow", factor=0.1), Run()
    yield Pages(run, Actions(top, run), threading.Lock())
    top.close()


@pytest.mark.parametrize("text", ["{", b"\xff", "[" * 100_000, "[]", '{"act": "jump"}'])
def test_what_is_no_request_is_refused(pages, text):
    assert "must be" in pages._act("page", text)["refused"]


def test_a_value_that_is_refused_is_refused(pages):
    answer = pages._act("page", json.dumps({"act": "kick", "factor": "much"}))
    assert answer["refused"].startswith("factor must be")


@pytest.mark.parametrize("bug", [ValueError, KeyError, ZeroDivisionError])
def test_a_bug_is_reported_as_one_and_is_no_refusal(pages, monkeypatch, capsys, bug):
    def fail(_):
        raise bug("by\na bug")

    monkeypatch.setattr(Actions, "toggle_pause", fail)
    answer = pages._act("page", json.dumps({"act": "pause"}))
    assert set(answer) == {"said"}
    assert f"a request failed: {bug.__name__}: " in answer["said"]
    assert capsys.readouterr().err == f"top_panel: {answer['said']}\n"
