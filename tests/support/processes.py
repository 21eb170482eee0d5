"""Python in a separate process, for claims about code that may end or stop a process."""

import os
import resource
import subprocess
import sys

# Seconds of the clock that only a hanging process exceeds, at any load of the machine.
HANG = 3600


def python(*arguments, seconds=HANG, **environment):
    """Runs `python ARGUMENT ...` with the paths of this process; a CompletedProcess with text."""
    return subprocess.run(
        [sys.executable, *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), **environment},
        capture_output=True, text=True, timeout=seconds, check=False)


def threaded(count=1, **more):
    """The environment of a program on so many threads."""
    return dict(os.environ, OMP_NUM_THREADS=str(count), OPENBLAS_NUM_THREADS=str(count), **more)


def limited(kind, size):
    """What limits a process that is about to start, such as the size of its files (FSIZE)."""
    return lambda: resource.setrlimit(getattr(resource, f"RLIMIT_{kind}"), (size, size))


def answer(script, **options):
    """The output of a script that must succeed."""
    result = python("-c", script, **options)
    assert result.returncode == 0, f"status {result.returncode}\n{result.stderr[-2000:]}"
    return result.stdout


# The system attributes to a process the memory of its parent at the start: hundreds of MB for the
# tests. This parent is smaller than any program.
_SMALL_PARENT = """
import os, sys
answer = os.dup(1)
os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
_, status, used = os.wait4(os.spawnvp(os.P_NOWAIT, sys.argv[1], sys.argv[1:]), 0)
os.write(answer, b"%d %d" % (os.waitstatus_to_exitcode(status), used.ru_maxrss))
"""


def status_and_memory(*command, cwd):
    """Exit status of a command and its largest memory [bytes]."""
    result = subprocess.run(
        [sys.executable, "-I", "-S", "-c", _SMALL_PARENT, *map(str, command)], cwd=cwd,
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=HANG, check=True)
    status, kilobytes = map(int, result.stdout.split())
    return status, 1024 * kilobytes
