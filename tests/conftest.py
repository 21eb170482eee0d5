"""Fixtures shared by all tests that go through the program, and how tests keep out of each other's
way when several run at once."""

import contextlib
import faulthandler
import fcntl
import os
import pathlib
import runpy
import signal
import subprocess
import sys

# Before anything loads OpenMP. Other tests run at the same time, and threads that wait for each
# other take their time: what is claimed of several threads asks for them.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest  # noqa: E402
from support.decks import RUNTIME_ERROR  # noqa: E402
from support.processes import HANG  # noqa: E402
from support.scenes import runner  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Seconds of the clock that only a test that hangs takes on a busy machine; a hundred times those of
# the slowest. Tests that take minutes have no limit.
LIMIT = 900


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="also run tests that take seconds")
    parser.addoption("--long", action="store_true", help="run all tests, also those of minutes")
    parser.addoption("--program", action="store_true", help="run only tests that run the program")


def pytest_collection_modifyitems(config, items):
    """Slow and long tests are left out, unless an option asks for them or a test is named."""
    names = ["long"] if config.getoption("--slow") else ["long", "slow"]
    if config.getoption("--long") or any("::" in argument for argument in config.args):
        names = []
    program = config.getoption("--program")
    left_out = [item for item in items if any(map(item.get_closest_marker, names))
                or (program and "snapin_path" not in item.fixturenames)]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


@contextlib.contextmanager
def _locked(name, kind):
    with open(ROOT / "tests" / name, "rb") as file:
        fcntl.flock(file, kind)
        yield


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Tests marked `alone` run while no other does; all others share the room.

    Whoever waits to be alone stands in the door meanwhile, so that nobody else comes in. The locks
    are on files that are there anyway.
    """
    alone = item.get_closest_marker("alone") is not None
    with contextlib.ExitStack() as room:
        with _locked("support/processes.py", fcntl.LOCK_EX):
            room.enter_context(_locked("conftest.py", fcntl.LOCK_EX if alone else fcntl.LOCK_SH))
        if item.get_closest_marker("long") is None:
            room.enter_context(_limited(item.name))
        return (yield)


@contextlib.contextmanager
def _limited(name):
    """A test that hangs fails, which ends the programs that it waits for; where compiled code
    hangs, the process ends with a trace of all threads."""
    def fail(*_):
        pytest.fail(f"{name} has taken {LIMIT} s", pytrace=True)

    before = signal.signal(signal.SIGALRM, fail)
    signal.alarm(LIMIT)
    faulthandler.dump_traceback_later(LIMIT + 60, exit=True, file=sys.__stderr__)
    try:
        yield
    finally:
        signal.alarm(0)
        faulthandler.cancel_dump_traceback_later()
        signal.signal(signal.SIGALRM, before)


@pytest.fixture(scope="session")
def snapin_path():
    """The executable under test: $SNAPIN, else build/snapin of this checkout."""
    path = pathlib.Path(os.environ.get("SNAPIN", ROOT / "build" / "snapin")).resolve()
    if not path.is_file():
        pytest.fail(f"no executable at {path}; build it first or set SNAPIN")
    return path


@pytest.fixture(scope="session")
def snapin(snapin_path):
    """Runs the program: snapin(arg, ..., cwd=DIR) -> CompletedProcess with text output."""

    def run(*args, cwd=None, timeout=HANG, **kwargs):
        return subprocess.run(
            [str(snapin_path), *map(str, args)], cwd=cwd, capture_output=True, text=True,
            errors="replace", timeout=timeout, check=False, **kwargs)

    return run


@pytest.fixture(scope="module")
def run(snapin, tmp_path_factory):
    """`support.scenes.runner`, whose runs the tests of a module share."""
    return runner(snapin, tmp_path_factory.mktemp("run"))


@pytest.fixture
def called(tmp_path, monkeypatch, capsys):
    """Runs a script in this process, which has imported what scripts need: called(path, argument,
    ...) -> CompletedProcess with text output, in a folder of the test."""
    monkeypatch.chdir(tmp_path)

    def run(path, *args):
        monkeypatch.syspath_prepend(path.parent)
        monkeypatch.setattr(sys, "argv", [str(path), *map(str, args)])
        status = 0
        try:
            runpy.run_path(str(path), run_name="__main__")
        except SystemExit as ended:
            status = ended.code or 0
        told = capsys.readouterr()
        if isinstance(status, str):
            told, status = told._replace(err=f"{told.err}{status}\n"), 1
        return subprocess.CompletedProcess([path.name], status, told.out, told.err)

    return run


@pytest.fixture
def check(snapin, tmp_path):
    """check(text or bytes) -> (exit status, stdout, stderr) for a deck called d.nml."""

    def run(text):
        data = text if isinstance(text, bytes) else text.encode()
        (tmp_path / "d.nml").write_bytes(data)
        done = snapin("--check", "d.nml", cwd=tmp_path)
        assert not RUNTIME_ERROR.search(done.stderr + done.stdout), done.stderr
        return done.returncode, done.stdout, done.stderr

    return run
