"""Automata that follow all ways to match a pattern together (Thompson 1968).

The work is that of the states of a pattern, once for each character of a text.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

Test = Callable[[str], bool]  # of a character


@dataclass(frozen=True, slots=True)
class Character:
    """One character that passes a test."""

    test: Test
    size: int = 1


@dataclass(frozen=True, slots=True)
class Anchor:
    """The beginning or the end of the text."""

    place: Literal["^", "$"]
    size: int = 1


@dataclass(frozen=True, slots=True)
class Sequel:
    """Parts one after the other."""

    parts: Sequence["Node"]

    @property
    def size(self) -> int:
        """Number of states."""
        return sum(part.size for part in self.parts)


@dataclass(frozen=True, slots=True)
class Choice:
    """One of some parts."""

    parts: Sequence["Node"]
    size: int


@dataclass(frozen=True, slots=True)
class Repeat:
    """A part, repeated; `most` is None without a limit."""

    part: "Node"
    least: int
    most: int | None
    size: int


Node = Character | Anchor | Sequel | Choice | Repeat


class Automaton:
    """States that are followed together. Each has a step, and the states after it."""

    def __init__(self, node: Node) -> None:
        # A state without a step is passed at once.
        self._steps: list[Character | Anchor | None] = []
        self._after: list[list[int]] = []
        self._final = self._add(None, [])
        self._first = self._build(node, self._final)

    def _add(self, step: Character | Anchor | None, after: list[int]) -> int:
        self._steps.append(step)
        self._after.append(after)
        return len(self._steps) - 1

    def _build(self, node: Node, after: int) -> int:
        """Add the states of a part that continues with a state; return its first one."""
        if isinstance(node, Character | Anchor):
            return self._add(node, [after])
        if isinstance(node, Choice):
            return self._add(None, [self._build(part, after) for part in node.parts])
        if isinstance(node, Repeat):
            return self._build_repeat(node, after)
        for part in reversed(node.parts):
            after = self._build(part, after)
        return after

    def _build_repeat(self, node: Repeat, after: int) -> int:
        if node.most is None:
            loop = self._add(None, [after])
            self._after[loop].append(self._build(node.part, loop))
            first = loop
        else:
            first = after
            for _ in range(node.most - node.least):
                first = self._add(None, [after, self._build(node.part, first)])
        for _ in range(node.least):
            first = self._build(node.part, first)
        return first

    def search(self, text: str) -> bool:
        """Return True if the final state is reached somewhere in a text."""
        reached: set[int] = set()
        for place in range(len(text) + 1):
            waiting = self._follow({*reached, self._first}, place == 0, place == len(text))
            if self._final in waiting:
                return True
            letter = text[place : place + 1]
            reached = set(self._read(waiting, letter)) if letter else set()
        return False

    def _follow(self, states: set[int], at_begin: bool, at_end: bool) -> set[int]:
        """Return all states that are reached without a character, those given included."""
        found, left = set(states), list(states)
        while left:
            state = left.pop()
            step = self._steps[state]
            if isinstance(step, Character) or (
                isinstance(step, Anchor) and not (at_begin if step.place == "^" else at_end)
            ):
                continue
            for each in self._after[state]:
                if each not in found:
                    found.add(each)
                    left.append(each)
        return found

    def _read(self, states: set[int], letter: str) -> Iterator[int]:
        """Yield the states after those that a character passes."""
        for state in states:
            step = self._steps[state]
            if isinstance(step, Character) and step.test(letter):
                yield from self._after[state]
