"""How commands in Python end: with a status, and with one line where they cannot write."""

import contextlib
import functools
import os
import pathlib
import sys
from collections.abc import Callable
from typing import Any

__all__ = ["as_command"]


def as_command(main: Callable[..., Any]) -> Callable[..., Any]:
    """Return main as a command that writes all of its output before it ends.

    Output that cannot be written, as into a full device, ends the command with one line on standard
    error and status 1; so does any other error of the system that main leaves. Without this the
    interpreter prints a traceback, or loses what is still in memory and ends with 120.
    """

    @functools.wraps(main)
    def command(*arguments, **options):
        try:
            try:
                return main(*arguments, **options)
            finally:
                if sys.stdout is not None:
                    sys.stdout.flush()
        except OSError as problem:
            _abandon(sys.stdout)
            place = problem.filename or "standard output"
            try:
                print(f"{pathlib.Path(sys.argv[0]).name}: {place}: {problem.strerror}",
                      file=sys.stderr, flush=True)
            except OSError:
                _abandon(sys.stderr)
            sys.exit(1)

    return command


def _abandon(stream):
    """Send what is left in a stream nowhere, so that the interpreter does not try again."""
    with contextlib.suppress(AttributeError, OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
