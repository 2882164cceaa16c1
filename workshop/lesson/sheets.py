"""Sheets of the lesson to print: one for the class, one with the answers for the teacher."""

import base64
from collections.abc import Sequence
from html import escape

from symtop_ros.web.lesson import LessonStep

STYLE = """
body { font: 11pt/1.4 Georgia, serif; color: #111; max-width: 178mm; margin: 8mm auto;
  padding: 0 4mm; }
h1 { font-size: 17pt; margin: 0 0 4mm; } h2 { font-size: 13pt; margin: 7mm 0 1mm; }
p { margin: 1mm 0; white-space: pre-line; } img { width: 100%; }
section { break-inside: avoid; } .line { border-bottom: 1px solid #888; height: 9mm; }
b { font-weight: 600; } code { font-size: 9.5pt; }
@page { size: A4; margin: 14mm; } @media print { body { margin: 0; padding: 0; } }
"""
LINES = '<div class="line"></div>' * 2
TITLE = "Why constants of motion?"
INTRODUCTION = (
    "theta is the tilt of the axis from the vertical, phi the precession, psi the spin; a dash is "
    "a rate. Open the page with: top_panel --lesson. Write your prediction first, then press."
)


def write_worksheet(steps: Sequence[LessonStep]) -> str:
    """Return the sheet for the class, with room for predictions and answers."""
    parts = [
        f"{_ask(k, step)}{LINES}{_act(step)}{_room(step)}" for k, step in enumerate(steps, start=1)
    ]
    return _document("worksheet", parts)


def write_teacher_sheet(steps: Sequence[LessonStep], pictures: Sequence[bytes]) -> str:
    """Return the sheet with what happens, the answers, and a picture (PNG) of each step."""
    parts = [
        f"{_ask(k, step)}{_act(step)}{_picture(step, picture)}{_answers(step)}"
        for k, (step, picture) in enumerate(zip(steps, pictures, strict=True), start=1)
    ]
    return _document("teacher's sheet", parts)


def _document(name: str, parts: Sequence[str]) -> str:
    sections = "\n".join(f"<section>{part}</section>" for part in parts)
    title = escape(f"{TITLE} ({name})")
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f"<style>{STYLE}</style></head>\n<body><h1>{title}</h1>"
        f"{_say('', INTRODUCTION)}\n{sections}\n</body></html>\n"
    )


def _say(name: str, text: str) -> str:
    label = f"<b>{escape(name)}:</b> " if name else ""
    return f"<p>{label}{escape(text)}</p>\n"


def _ask(number: int, step: LessonStep) -> str:
    return f"<h2>{number}. {escape(step.title)}</h2>\n{_say('Predict', step.predict)}"


def _act(step: LessonStep) -> str:
    compute = _say("Compute", step.compute) if step.compute else ""
    buttons = ", then ".join(act.button for act in step.acts)
    return f"{compute}{_say('Press', buttons)}{_say('Observe', step.look)}"


def _room(step: LessonStep) -> str:
    lines = LINES * (2 if step.compute else 1)  # more to write where something is computed
    return f"{_say('What you saw, and why', '')}{lines}{_say('Question', step.question)}{LINES}"


def _picture(step: LessonStep, picture: bytes) -> str:
    data = base64.b64encode(picture).decode()
    return f'<img alt="{escape(step.picture)}" src="data:image/png;base64,{data}">\n'


def _answers(step: LessonStep) -> str:
    commands = "; ".join(step.commands)
    return (
        f"{_say('Explain', step.seen)}{_say('Question', step.question)}"
        f"{_say('Answer', step.answer)}{_say('In the article', step.source)}"
        f"<p><b>With ROS:</b> <code>{escape(commands)}</code></p>\n"
    )
