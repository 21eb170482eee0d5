"""Claims about runs whose files cannot be written, or whose messages nobody hears."""

import errno
import os
import subprocess

import pytest
from support.interrupted import Bench, frames, rows, short, sweep  # noqa: F401
from support.processes import limited, threaded
from support.scenes import lennard_jones


# --- Where files cannot be written

def check_stopped(bench, done, folder, words):
    """A run that could not write: told, and nothing that looks complete."""
    assert done.returncode == 1, done.stderr
    assert words in done.stderr
    assert [path.name for path in folder.iterdir()] == ["unfinished"]


@pytest.mark.parametrize("name", ["short", "sweep"])
def test_a_limit_on_the_size_of_files_stops_a_run_that_then_goes_on(name, request):
    bench = request.getfixturevalue(name)
    whole = bench.folder / "whole/deck"
    (table,) = [*whole.glob("curve.csv"), *whole.glob("sweep.csv")]
    largest = table.stat().st_size
    for limit in (0, 100, 1500, 2500, largest // 2, largest - 1):
        folder = bench.emptied()
        done = bench.run("cut", preexec_fn=limited("FSIZE", limit))
        check_stopped(bench, done, folder, "File too large; raise the limit")
        if limit == largest // 2 and name == "sweep":
            # What could not be kept is not computed either.
            (table,) = folder.glob("unfinished/sweep.csv")
            whole = rows(bench.whole[table.name])
            assert len(rows(table.read_bytes().splitlines())) < 0.8 * len(whole)
        assert bench.run("cut", "--resume").returncode == 0
        assert bench.files("cut") == bench.whole


@pytest.mark.slow
def test_a_journal_that_cannot_grow_stops_a_run_that_then_goes_on(snapin, snapin_path, tmp_path):
    """Cases are written every twentieth of a second: these take several."""
    cases = {"key": "force.hamaker", "from_": 1.0, "to": 100.0, "count": 120, "scale": "log"}
    long = lennard_jones(0.2, equilibrium_path={"h0_end": -2.0}, numerics={"accuracy": 1e-9},
                         sweep=cases)
    sweep = Bench(snapin, snapin_path, tmp_path, long)
    folder = sweep.emptied()
    env = threaded(1, LD_PRELOAD=str(sweep.library), FAULT_CALL="write", FAULT_AT="2",
                   FAULT_ERRNO=str(errno.EFBIG), FAULT_UNDER="cut/deck/unfinished/journal")
    done = sweep.snapin("--out", "cut", "deck.nml", cwd=sweep.folder, env=env)
    check_stopped(sweep, done, folder, "File too large; raise")
    done = sweep.run("cut", "--resume")
    assert done.returncode == 0
    assert "continuing" in done.stderr
    assert sweep.files("cut") == sweep.whole


def test_a_full_disk_stops_a_run_that_then_goes_on(short, tmp_path):
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", tmp_path],
                      capture_output=True, check=False).returncode:
        pytest.skip("this user may not mount a small disk")
    try:
        done = short.run(tmp_path)
        check_stopped(short, done, tmp_path / "deck", "No space left on device; make room")
        subprocess.run(["mount", "-o", "remount,size=4m", tmp_path], check=True)
        done = short.run(tmp_path, "--resume")
        assert done.returncode == 0
        assert "run again from the beginning" in done.stderr
        assert short.files(tmp_path) == short.whole
    finally:
        subprocess.run(["umount", tmp_path], check=True)


@pytest.mark.parametrize("out", ["/proc/none", "deck.nml"])
def test_a_folder_that_cannot_be_made_is_told_at_once(short, out):
    done = short.run(out)
    assert done.returncode == 1
    assert f"cannot make the folder {out}" in done.stderr
    assert "--out" in done.stderr


def test_a_folder_that_may_not_be_written_is_told_at_once(short, tmp_path):
    if os.geteuid() == 0:
        pytest.skip("this user may write everywhere")
    (tmp_path / "deck").mkdir(mode=0o555)
    done = short.run(tmp_path)
    assert done.returncode == 1
    assert "Permission denied" in done.stderr
    assert list((tmp_path / "deck").iterdir()) == []


# --- Where nobody listens


def close(*descriptors):
    def closing():
        for descriptor in descriptors:
            os.close(descriptor)

    return closing


@pytest.mark.parametrize("closed", [(2,), (1, 2), (0, 1, 2)], ids=str)
def test_messages_never_end_up_in_results_when_streams_are_closed(short, closed):
    # There is something to say while files are open.
    begun = b"".join(frames(short.journal)[:9])
    for options in [("--resume",), ()]:
        short.emptied(begun)
        done = short.run("cut", *options, preexec_fn=close(*closed))
        assert done.returncode == 0
        assert short.files("cut") == short.whole


def test_a_closed_pipe_or_a_full_terminal_log_does_not_end_a_run(short):
    reader, writer = os.pipe()
    os.close(reader)
    full = os.open("/dev/full", os.O_WRONLY)
    try:
        for stream in (writer, full):
            short.emptied()
            done = subprocess.run(
                [short.path, "--out", "cut", "--resume", "deck.nml"], cwd=short.folder,
                env=threaded(), stderr=stream, check=False)
            assert done.returncode == 0
            assert short.files("cut") == short.whole
    finally:
        os.close(writer)
        os.close(full)
