"""Fixtures shared by all tests that go through the program, and how tests keep out of each other's
way when several run at once."""

import contextlib
import fcntl
import os
import pathlib
import runpy
import subprocess
import sys

# Before anything loads OpenMP. Other tests run at the same time: two threads are enough to be more
# than one, and while they wait they leave the core to others. OpenBLAS's own do not.
os.environ.setdefault("OMP_NUM_THREADS", "2")
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest  # noqa: E402
from support.decks import RUNTIME_ERROR  # noqa: E402
from support.processes import HANG  # noqa: E402
from support.scenes import runner  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="also run tests that take minutes")


def pytest_collection_modifyitems(config, items):
    if config.getoption("--long"):
        return
    for item in items:
        if "long" in item.keywords:
            item.add_marker(pytest.mark.skip(reason="takes minutes: --long"))


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
        return (yield)


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
