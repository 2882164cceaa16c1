"""docs/lesson.md: its steps are written from the data of the lesson."""

import re
import textwrap
from pathlib import Path

from workshop.lesson.steps import LessonStep, LessonTable, read_lesson

PAGE = Path(__file__).parents[2] / "docs/lesson.md"
FIRST = "## 1. "  # what is above the first step is written by hand
WIDTH = 100
# Options of the viewer for what it does not show by itself
OPTIONS = {"fictitious torques": "--fictitious"}


def write_page() -> str:
    """Return the page with its steps from the data."""
    head = PAGE.read_text(encoding="utf-8").partition(FIRST)[0]
    steps = list(enumerate(read_lesson(), start=1))
    answers = [_wrap(f"{k}. {step.answer}", "   ") for k, step in steps]
    parts = [*(_write_step(k, step) for k, step in steps), "## Answers for the teacher\n"]
    return head + "\n".join([*parts, *answers]) + "\n"


def _write_step(number: int, step: LessonStep) -> str:
    commands = "\n".join(step.commands)
    return "\n\n".join(
        [
            f"## {number}. {step.title}",
            _wrap(f"Predict: {step.predict}"),
            *map(_wrap, filter(None, step.compute.split("\n"))),
            f"[On the page](../top.html#lesson={number}), or {_name_other_way(step)}:",
            f"```sh\n{commands}\n```",
            _wrap(f"Observe: {step.look}{_name_view(step)}"),
            f"![{step.picture}](lesson/step_{number:02}.png)",
            *map(_wrap, filter(None, f"Explain: {step.seen}".split("\n"))),
            *_write_table(step.table),
            _wrap(f"Question: {step.question} (In the article: {step.source}.)") + "\n",
        ]
    )


def _name_other_way(step: LessonStep) -> str:
    return "on a command line" if step.has_record else "with a node"


def _write_table(table: LessonTable | None) -> list[str]:
    """Return the table of a step, if it has one."""
    if not table:
        return []
    rows = [table.headings, ["--:"] * len(table.forms), *table.cells]
    return ["\n".join(f"| {' | '.join(row)} |" for row in rows)]


def _name_view(step: LessonStep) -> str:
    """Return how the viewer shows what the page shows in a step only."""
    options = " ".join(OPTIONS[layer] for layer in step.layers if layer in OPTIONS)
    return (
        f" (With ROS: `top_live {options}`, or `top_replay {options}` of a log.)" if options else ""
    )


def _wrap(text: str, indent: str = "") -> str:
    # A line that begins with a sign would be a list.
    text = re.sub(" ([+-]) ", "\u00a0\\1 ", text.replace("<", "&lt;"))
    return textwrap.fill(
        text, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
