"""Python in a process of its own, for claims about what may end or stop a process."""

import os
import subprocess
import sys

# Seconds of the clock that only what hangs takes, however busy the machine is.
HANG = 3600


def python(*arguments, seconds=HANG, **environment):
    """Runs `python ARGUMENT ...` with the paths of this process; a CompletedProcess with text."""
    return subprocess.run(
        [sys.executable, *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), **environment},
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )


def answer(script, **options):
    """What a script prints that must succeed."""
    result = python("-c", script, **options)
    assert result.returncode == 0, f"status {result.returncode}\n{result.stderr[-2000:]}"
    return result.stdout
