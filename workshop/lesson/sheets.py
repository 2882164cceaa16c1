"""Sheets of the lesson to print: one for the class, one with the answers for the teacher."""

import base64
from collections.abc import Sequence
from html import escape
from pathlib import Path

from symtop_ros.web.join import read_texts
from workshop.lesson.steps import LessonStep, read_lesson

STYLE = Path(__file__).with_suffix(".css").read_text(encoding="utf-8")
LINES = '<div class="line"></div>' * 2


class Sheets:
    """The sheets in a language."""

    def __init__(self, language: str) -> None:
        self.language = language
        self._texts = read_texts(language)
        self._steps = list(enumerate(read_lesson(language), start=1))

    def write_worksheet(self) -> str:
        """Return the sheet for the class, with room for predictions and answers."""
        parts = [
            f"{self._ask(k, step)}{LINES}{self._act(step)}{self._room(step)}"
            for k, step in self._steps
        ]
        return self._document("worksheet", parts)

    def write_teacher_sheet(self, pictures: Sequence[bytes]) -> str:
        """Return the sheet with what happens, the answers, and a picture (PNG) of each step."""
        parts = [
            f"{self._ask(k, step)}{self._act(step)}{_show(step, picture)}{self._answer(step)}"
            for (k, step), picture in zip(self._steps, pictures, strict=True)
        ]
        return self._document("teacher", parts)

    def _document(self, name: str, parts: Sequence[str]) -> str:
        sections = "\n".join(f"<section>{part}</section>" for part in parts)
        title = escape(f"{self._texts['sheet.title']} ({self._texts[f'sheet.{name}']})")
        return (
            f'<!doctype html>\n<html lang="{self.language}"><head><meta charset="utf-8">'
            f"<title>{title}</title><style>\n{STYLE}</style></head>\n<body><h1>{title}</h1>"
            f"<p>{escape(self._texts['sheet.introduction'])}</p>\n{sections}\n</body></html>\n"
        )

    def _say(self, name: str, text: str) -> str:
        return f"<p><b>{escape(self._texts[f'sheet.{name}'])}:</b> {escape(text)}</p>\n"

    def _ask(self, number: int, step: LessonStep) -> str:
        return f"<h2>{number}. {escape(step.title)}</h2>\n{self._say('predict', step.predict)}"

    def _act(self, step: LessonStep) -> str:
        compute = self._say("compute", step.compute) if step.compute else ""
        buttons = self._texts["sheet.then"].join(act.button for act in step.acts)
        return f"{compute}{self._say('press', buttons)}{self._say('observe', step.look)}"

    def _room(self, step: LessonStep) -> str:
        lines = LINES * (2 if step.compute else 1)  # more to write where something is computed
        return f"{self._say('saw', '')}{lines}{self._say('question', step.question)}{LINES}"

    def _answer(self, step: LessonStep) -> str:
        parts = {"explain": step.seen, "question": step.question, "answer": step.answer}
        said = [self._say(name, text) for name, text in (*parts.items(), ("article", step.source))]
        commands = f"<code>{escape('; '.join(step.commands))}</code>"
        return f"{''.join(said)}<p><b>{self._texts['sheet.ros']}:</b> {commands}</p>\n"


def _show(step: LessonStep, picture: bytes) -> str:
    data = base64.b64encode(picture).decode()
    return f'<img alt="{escape(step.picture)}" src="data:image/png;base64,{data}">\n'
