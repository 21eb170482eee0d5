"""Claims about whose results a run from Python returns, and that they are whole."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import pytest
import snapin
from snapin import experiment
from support.scenes import lennard_jones, loading

CURVE = lennard_jones(0.5, loading=loading(6, 2, 0.5))
PATH = lennard_jones(0.3, equilibrium_path={"h0_end": -1.0})
OTHER = CURVE.replace("hamaker = ", "hamaker = 1")
RIGHT = {}


def tension(text):
    """The largest tension of a deck, run alone."""
    if text not in RIGHT:
        RIGHT[text] = snapin.run(text).summary["max_tension"]
    return RIGHT[text]


def test_a_run_never_returns_results_of_another_in_the_same_folder(tmp_path):
    """A refused run took the results that another run had just put there for its own."""
    assert tension(CURVE) != tension(OTHER)
    ends = []

    def work(text):
        for _ in range(30):
            try:
                ends.append(snapin.run(text, out=tmp_path).summary["max_tension"] == tension(text))
            except snapin.SnapinError as problem:
                ends.append("another run is writing into this folder" in str(problem))

    workers = [threading.Thread(target=work, args=(text,)) for text in (CURVE, OTHER) * 2]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert ends == [True] * 120


@pytest.mark.parametrize("status", [1, 2, 3, 127])
def test_a_run_that_wrote_nothing_returns_nothing_whatever_is_in_the_folder(
        tmp_path, monkeypatch, status):
    """Another run publishes into the folder while this one ends; the summary is newer than it."""
    def ends(arguments, text, quiet):
        carried_out(["--into", str(tmp_path), "-"], OTHER.encode(), True)
        return status, b"", "refused"

    carried_out, right = experiment._carry_out, tension(OTHER)
    monkeypatch.setattr(experiment, "_carry_out", ends)
    for resume in (False, True):
        with pytest.raises(snapin.SnapinError, match="refused"):
            snapin.run(CURVE, out=tmp_path, resume=resume)
    assert snapin.read_results(tmp_path).summary["max_tension"] == right


def test_reading_never_mixes_two_runs(tmp_path):
    """Two decks take turns in one folder, which is read all the while."""
    rows = {text: len(snapin.run(text, out=tmp_path).curve) for text in (CURVE, PATH)}
    assert len({*rows.values()}) == 2
    of_tension = {tension(text): rows[text] for text in rows}
    stop = threading.Event()

    def work():
        while not stop.is_set():
            for text in rows:
                snapin.run(text, out=tmp_path)

    writer = threading.Thread(target=work)
    writer.start()
    try:
        until = time.monotonic() + 3
        reads = 0
        while time.monotonic() < until or reads < 20:
            found = snapin.read_results(tmp_path)
            assert len(found.curve) == of_tension[found.summary["max_tension"]]
            reads += 1
    finally:
        stop.set()
        writer.join()


@pytest.mark.parametrize("status", [0, 1])
def test_a_stream_that_ends_anywhere_before_its_end_is_no_result(monkeypatch, status):
    """787 of 5,164 beginnings of a stream were taken for results: those with a summary in them."""
    arguments = ["--out", "-", "--quiet", "-"]
    whole = experiment._carry_out(arguments, CURVE.encode(), True)[1]
    assert whole.endswith(b"\ncomplete 0\n") and b"summary.nml " in whole
    for cut in range(len(whole)):
        monkeypatch.setattr(experiment, "_carry_out", lambda *_, c=cut: (status, whole[:c], "cut"))
        with pytest.raises(snapin.SnapinError, match="^cut$"):
            snapin.run(CURVE)
    monkeypatch.setattr(experiment, "_carry_out", lambda *_: (0, whole, ""))
    assert snapin.run(CURVE).summary["max_tension"] == tension(CURVE)


@pytest.mark.parametrize("status", [-9, -11, -15, -64, 2, 3, 126, 127, 134, 137, 255])
def test_every_status_but_0_and_1_is_an_error_though_the_stream_is_whole(monkeypatch, status):
    whole = experiment._carry_out(["--out", "-", "--quiet", "-"], CURVE.encode(), True)[1]
    monkeypatch.setattr(experiment, "_carry_out", lambda *_: (status, whole, ""))
    for out in (None, "here"):
        with pytest.raises(snapin.SnapinError):
            snapin.run(CURVE, out=out)


def test_a_program_that_is_killed_is_told_by_the_name_of_the_signal(monkeypatch, tmp_path):
    script = tmp_path / "snapin"
    script.write_text("#!/bin/sh\nkill -9 $$\n")
    script.chmod(0o755)
    monkeypatch.setattr(experiment, "_program", lambda: str(script))
    for quiet in (True, False):
        with pytest.raises(snapin.SnapinError, match="SIGKILL"):
            snapin.run(CURVE, quiet=quiet)


@pytest.mark.parametrize("out", ["-", pathlib.Path("-")])
def test_a_folder_called_as_standard_output_is_refused_at_once(out, monkeypatch):
    """The deck was computed, and then there was no summary in the folder."""
    monkeypatch.setattr(experiment, "_carry_out", None)
    with pytest.raises(ValueError, match="^out: '-' is no folder"):
        snapin.run(CURVE, out=out)


def test_an_empty_name_of_a_folder_is_refused(monkeypatch):
    """The results went into the folder of the process."""
    monkeypatch.setattr(experiment, "_carry_out", None)
    with pytest.raises(ValueError, match="^out: an empty name is no folder"):
        snapin.run(CURVE, out="")


@pytest.mark.parametrize("quiet", [True, False])
@pytest.mark.parametrize("out", [None, "here"])
def test_a_run_ends_with_its_python(out, quiet, tmp_path):
    """With a folder for its results a run went on when Python had been killed, and blocked it."""
    long = lennard_jones(0.5, loading=loading(6, 2, 1e-6))
    script = f"import snapin; snapin.run({long!r}, out={out!r}, quiet={quiet})"
    with subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, stderr=subprocess.DEVNULL,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}) as python:
        children = pathlib.Path(f"/proc/{python.pid}/task/{python.pid}/children")
        while not (found := children.read_text().split()):
            assert python.poll() is None
            time.sleep(0.01)
        program = pathlib.Path("/proc", found[0])
        while out and not (tmp_path / "here/unfinished/curve.csv").exists():
            time.sleep(0.01)
        time.sleep(0.1)
        python.send_signal(signal.SIGKILL)
    for _ in range(500):
        # A zombie without further threads waits only for its new parent. While another thread is
        # ending, the files of the program are still open, and its folder is locked.
        try:
            if " Z " in (program / "stat").read_text() and len(list(program.glob("task/*"))) == 1:
                break
        except OSError:
            break
        time.sleep(0.01)
    else:
        os.kill(int(found[0]), signal.SIGKILL)
        pytest.fail("the program still runs")
    if out:
        # The folder is free, and what was computed can be read.
        assert (tmp_path / "here/unfinished/curve.csv").read_bytes().startswith(b"# title:")
        assert snapin.run(CURVE, out=tmp_path / "here").converged
