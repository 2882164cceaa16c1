"""Words of the command line that the programs share, and their failures in one line."""

import argparse
import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn

from symtop_ros import __version__
from symtop_ros.base.refusals import find_nearest, one_line, plain


def tell_failures(name: str, act: Callable[[], int]) -> int:
    """Return the status of an action; refusals and failing files are printed in one line.

    That the output is no longer read is no failure of it: the program ends as by that signal.
    """
    try:
        return act()
    except BrokenPipeError:
        raise
    except ValueError as error:
        text = one_line(error)
    except OSError as error:
        text = f"{one_line(error.filename or 'output')}: {error.strerror}"
    print(f"{name}: {text}", file=sys.stderr)
    return 1


class Parser(argparse.ArgumentParser):
    """A parser whose errors name the word that is nearest to one that is unknown."""

    forms: Mapping[str, str] = {}  # right forms by words that are no options

    def error(self, message: str) -> NoReturn:
        """Print the usage and what is wrong, and end the program with status 2."""
        super().error(message + _suggest(message, self._option_string_actions, self.forms))


def _suggest(message: str, options: Iterable[str], forms: Mapping[str, str]) -> str:
    """Return what may have been meant by an unknown argument or choice, or nothing."""
    if found := re.match(r"unrecognized arguments: -*([^\s:=]+)(?::?=(\S+))?", message):
        if nearest := find_nearest(found[2] or "", forms):
            return f" (nearest: {forms[nearest]})"
        known = {**forms, **{option.lstrip("-"): option for option in options}}
    elif found := re.search(r"invalid choice: '([^']+)' \(choose from (.*)\)", message):
        known = {word: word for word in re.findall(r"[\w-]+", found[2])}
    else:
        return ""
    nearest = find_nearest(found[1], known)
    return f" (nearest: {known[nearest]})" if nearest else ""


def new_parser(name: str, description: str, **more: Any) -> Parser:
    """Return the parser of a program, which has --version."""
    parser = Parser(prog=name, description=description, **more)
    parser.add_argument("--version", action="version", version=f"{name} {__version__}")
    return parser


def port(text: str) -> int:
    """Read the number of a port."""
    if not text.isdecimal() or int(text) >= 2**16:
        raise argparse.ArgumentTypeError(f"must be 0 to 65535, got {one_line(text, 60)}")
    return int(text)


def decimal(text: str) -> float:
    """Read a number."""
    return float(plain(text))


def integer(text: str) -> int:
    """Read an integer."""
    return int(plain(text))


def positive(text: str) -> float:
    """Read a finite number above 0."""
    try:
        value = decimal(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0, got {one_line(text)}")
    return value


def has_screen() -> bool:
    """Return True if a window can be opened; else some browsers open in the terminal."""
    return sys.platform in {"darwin", "win32"} or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )
