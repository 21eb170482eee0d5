"""Claims about whose journal and whose folder it is: other decks, programs and runs."""

import fcntl
import os
import shutil
import signal
import subprocess
import time

import pytest
from support.interrupted import frames, heading, linked_id, owner, sweep, SWEEP  # noqa: F401
from support.processes import threaded
from support.scenes import lennard_jones, loading


def state_of(folder):
    """Contents and times of the files of a folder."""
    return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in folder.iterdir()}


def changes(text):
    """Changed decks, and what is said of them."""
    before, after = text.split("&unloading\n")
    without = before + after.partition("/\n")[2]
    yield text.replace("to = 100.0", "to = 200.0"), "&sweep to = 100 instead of 200"
    yield text.replace("count = 9", "count = 8"), "&sweep count = 9 instead of 8"
    yield without, "one with &unloading"
    yield text + "&classical /\n", "one without &classical"
    yield "&scene title = 'x' /\n" + text, "one without &scene"


def test_another_deck_is_refused_and_told_apart(sweep):
    journal = b"".join(frames(sweep.journal)[:3])
    path = sweep.folder / "deck.nml"
    try:
        for text, words in changes(SWEEP):
            path.write_text(text)
            done = sweep.resume(journal)
            assert done.returncode == 1
            assert "cannot continue" in done.stderr
            assert words in done.stderr
            assert "without --resume" in done.stderr
            target = sweep.folder / "cut/deck"
            assert [p.name for p in target.iterdir()] == ["unfinished"]
            assert (target / "unfinished/journal").read_bytes() == journal
    finally:
        path.write_text(SWEEP)


@pytest.mark.parametrize("line", ["program: ", "libraries: "])
def test_another_program_is_refused(sweep, line):
    first, *cases = frames(sweep.journal)
    lines = owner(first).splitlines(keepends=True)
    changed = "".join(line + "0.0.0\n" if each.startswith(line) else each for each in lines)
    assert changed != owner(first)
    done = sweep.resume(heading(changed) + cases[0])
    assert done.returncode == 1
    assert "0.0.0" in done.stderr
    assert "continue with that one" in done.stderr
    # The heading is read as it was written.
    sweep.check(heading(owner(first)) + cases[0])


def test_the_program_is_known_by_what_was_linked(sweep):
    """Sources that differ link to another id, the same ones to the same."""
    assert f"(build {linked_id(sweep.path)})\n" in owner(frames(sweep.journal)[0])


# --- With nothing to go on with


def test_resume_without_anything_to_resume_begins_at_the_beginning_and_says_so(sweep):
    done = sweep.run("fresh", "--resume")
    assert done.returncode == 0
    assert "no interrupted run to continue" in done.stderr
    assert sweep.files("fresh") == sweep.whole


def test_resume_leaves_finished_results_as_they_are(sweep):
    target = sweep.folder / "whole/deck"
    before = state_of(target)
    done = sweep.run("whole", "--resume")
    assert done.returncode == 0
    assert "complete since an earlier run" in done.stderr
    assert state_of(target) == before


def test_resume_keeps_the_exit_status_of_a_finished_run_that_failed(snapin, tmp_path):
    numerics = {"method": "mixing", "max_iterations": 3, "nodes": 200}
    text = lennard_jones(0.87, loading=loading(5, 3, 1), numerics=numerics)
    (tmp_path / "deck.nml").write_text(text)
    assert snapin("deck.nml", cwd=tmp_path).returncode == 1
    done = snapin("--resume", "deck.nml", cwd=tmp_path)
    assert done.returncode == 1
    assert "complete since an earlier run" in done.stderr


@pytest.mark.parametrize("parts", [0, 1])
def test_a_run_that_left_no_case_is_not_said_to_be_continued(sweep, parts):
    """Also a sweep that was refused since its file of cases had changed leaves an empty journal."""
    sweep.emptied(b"".join(frames(sweep.journal)[:parts]))
    done = sweep.run("cut", "--resume")
    assert done.returncode == 0
    assert "left nothing to continue; starting from the beginning" in done.stderr
    assert "continuing a run" not in done.stderr
    assert sweep.files("cut") == sweep.whole


def test_without_resume_what_was_interrupted_is_dropped_and_that_is_said(sweep):
    sweep.emptied(b"".join(frames(sweep.journal)[:3]))
    done = sweep.run("cut")
    assert done.returncode == 0
    assert "starting over" in done.stderr
    assert sweep.files("cut") == sweep.whole


# --- Two runs, one folder


@pytest.mark.parametrize("options", [[], ["--resume"]])
def test_a_second_run_is_refused_and_touches_nothing(sweep, options):
    target = sweep.emptied(b"".join(frames(sweep.journal)[:3]))
    (target / "unfinished/curve.csv").write_text("# title: x")
    before = state_of(target / "unfinished")
    folder = os.open(target, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        done = sweep.run("cut", *options)
    finally:
        os.close(folder)
    assert done.returncode == 1
    assert "another run is writing" in done.stderr
    assert "--out" in done.stderr
    assert state_of(target / "unfinished") == before
    # The lock is gone with its holder.
    assert sweep.run("cut", *options).returncode == 0


@pytest.mark.parametrize("away", ["removed", "moved", "a file removed"])
def test_a_run_whose_folder_is_gone_publishes_nothing_and_touches_no_other(
        snapin_path, tmp_path, away):
    (tmp_path / "deck.nml").write_text(lennard_jones(0.87, loading=loading(9, -3, 0.002)))
    folder = tmp_path / "results/deck"
    folder.mkdir(parents=True)
    earlier = "&summary of an earlier run"
    (folder / "summary.nml").write_text(earlier)
    with subprocess.Popen([snapin_path, "deck.nml"], cwd=tmp_path, env=threaded(),
                          stderr=subprocess.PIPE, text=True) as process:
        while not (folder / "unfinished/curve.csv").exists():
            assert process.poll() is None, process.communicate()[1]
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        assert (folder / "unfinished/journal").exists()
        if away == "moved":
            folder.rename(tmp_path / "elsewhere")
        elif away == "removed":
            shutil.rmtree(folder)
        else:
            (folder / "unfinished/curve.csv").unlink()
        # Another run begins there.
        (folder / "unfinished").mkdir(parents=True, exist_ok=True)
        others = {"unfinished/curve.csv": "x", "unfinished/summary.nml": "y",
                  "unfinished/journal": "z", "classical.csv": "t"}
        if away == "a file removed":
            others = {"summary.nml": earlier}
        for name, text in others.items():
            (folder / name).write_text(text)
        process.send_signal(signal.SIGCONT)
        message = process.communicate()[1]
    assert process.returncode == 1
    if away != "moved":
        assert "was removed or moved away during the run" in message
        assert {name: (folder / name).read_text() for name in others} == others
    else:
        # The summary had to be opened by name; nothing got its name.
        del others["unfinished/summary.nml"]
        assert {name: (folder / name).read_text() for name in others} == others
        left = sorted(p.name for p in (tmp_path / "elsewhere").iterdir())
        assert left == ["summary.nml", "unfinished"]
        assert (tmp_path / "elsewhere/summary.nml").read_text() == earlier
