"""Lines of Python in a separate process, and programs where some modules are missing."""

import os
import subprocess
import sys
from pathlib import Path

from programs import execute


def run_python(
    code: str, *arguments: object, cwd: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run some lines of Python to their end, in a separate process."""
    words = [sys.executable, "-c", code, *arguments]
    return execute(words, timeout=120, cwd=cwd, env={**os.environ, **environment})


def run_without(
    modules: tuple[str, ...], program: str, *arguments: str, cwd: Path
) -> subprocess.CompletedProcess[str]:
    """Run a program as where some modules are not installed."""
    code = f"import sys; sys.modules.update(dict.fromkeys({modules})); "
    code += f"from symtop_ros import programs; sys.exit(programs.{program}())"
    return run_python(code, *arguments, cwd=cwd, PYTHONPATH=str(Path(__file__).parents[1]))
