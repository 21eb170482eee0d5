"""Fixtures shared by all tests that go through the program."""

import os
import pathlib
import subprocess

import pytest
from decks import RUNTIME_ERROR

ROOT = pathlib.Path(__file__).resolve().parent.parent


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="also run tests that take minutes")


def pytest_collection_modifyitems(config, items):
    if config.getoption("--long"):
        return
    for item in items:
        if "long" in item.keywords:
            item.add_marker(pytest.mark.skip(reason="takes minutes: --long"))


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

    def run(*args, cwd=None, timeout=300, **kwargs):
        return subprocess.run(
            [str(snapin_path), *map(str, args)],
            cwd=cwd,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            check=False,
            **kwargs,
        )

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
