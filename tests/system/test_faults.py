"""Claims about results when system calls fail, runs are killed, or the power does (faults.py)."""

import errno
import os
import re
import signal
import subprocess
import time

import pytest
from support import faults
from support.scenes import lennard_jones, loading


@pytest.fixture(scope="module")
def stand(snapin_path, tmp_path_factory):
    return faults.Stand(snapin_path, tmp_path_factory.mktemp("faults"))


@pytest.fixture(scope="module")
def fresh(snapin_path, tmp_path_factory):
    return faults.Stand(snapin_path, tmp_path_factory.mktemp("fresh"), old=None)


@pytest.fixture(params=["stand", "fresh"])
def either(request):
    """Old results that are replaced, or a new folder."""
    return request.getfixturevalue(request.param)


# --- A sample; `verify.sh faults` tries every call with every error


@pytest.mark.parametrize("code", [faults.KILL, errno.EIO], ids=["killed", "EIO"])
def test_a_rename_that_fails_leaves_one_set_of_results_or_says_so(either, code):
    for at in range(1, either.number("rename") + 1):
        end = either.attempt("rename", at, code)
        if code:
            # The first one is that of the file of intent.
            assert end == f"status 1, {'told' if at > 1 else either.before}"


@pytest.mark.parametrize("code", [faults.KILL, errno.ENOSPC], ids=["killed", "ENOSPC"])
def test_no_failing_call_leaves_results_that_are_not_one_set(either, code):
    for at in range(1, either.number("any") + 1, 7):
        either.attempt("any", at, code)


def test_a_disk_that_fails_for_good_amid_the_renames_is_told_and_mended(either):
    number = either.number("rename")
    ends = [either.attempt("rename", at, errno.EIO, lasts=True) for at in range(1, number + 1)]
    assert ends.count("status 1, told") == number - 1


def test_a_power_failure_at_any_call_leaves_one_set_of_results_or_says_so(either):
    ends = faults.power_failures(either, every=5)
    assert ends[either.before] and ends["told"] and ends["new"]


@pytest.mark.long
def test_every_call_may_fail(either):
    broken = [line for *_, bad in faults.campaign(either) for line in bad]
    assert not broken
    ends = faults.power_failures(either)
    assert ends[either.before] and ends["new"] and ends["told"]


@pytest.mark.parametrize("code", [faults.KILL, errno.EIO], ids=["killed", "EIO"])
def test_mending_that_is_interrupted_is_mended(either, code):
    def stop():
        either.reset()
        either.run(call="rename", at=4, errno=faults.KILL, under="try/d")
        assert either.state() == "told"

    stop()
    log = either.folder / "mending.log"
    either.run("try", "--resume", call="any", under="try/d", log=log)
    calls = [line.split("\t")[0] for line in log.read_text().splitlines()]
    for call in ("rename", "fsync"):
        for at in range(1, min(calls.count(call), 8) + 1):
            stop()
            either.run("try", "--resume", call=call, at=at, errno=code, under="try/d")
            either.state()
            either.mend()


def test_files_wait_for_the_disk_no_more_often_than_the_order_of_steps_needs(either):
    # Each file, the list of them, the folder four times, and the one above it.
    assert either.number("fsync") == len(either.new) + 1 + 4 + 1


def test_every_file_is_on_the_disk_before_it_gets_its_name(either):
    synced, dirty_names, renamed = set(), set(), []
    for name, _, path, *rest in either.log()[:-1]:
        file = path.rsplit("/", 1)[-1]
        if path == faults.INTENT and name in ("rename", "unlink"):
            # Now the set is complete.
            assert not dirty_names
        if name in ("write", "truncate"):
            synced.discard(file)
        elif name == "create":
            dirty_names.add(file)
        elif name == "fsync" and path.endswith("/d"):
            dirty_names.clear()
        elif name == "fsync":
            synced.add(file)
        elif name == "rename":
            dirty_names.add(rest[0])
            assert path in synced and path not in dirty_names
            synced.add(rest[0])
            renamed.append(rest[0])
    assert renamed[0] == faults.INTENT
    assert sorted(renamed) == sorted([faults.INTENT, *either.new])
    assert renamed[-1] == "summary.nml"


# --- What a reader is told


def test_a_folder_that_was_left_amid_the_renames_tells_how_to_mend_it_by_hand(either):
    either.reset()
    either.run(call="rename", at=4, errno=faults.KILL, under="try/d")
    text = (either.target / faults.INTENT).read_text()
    assert "may not belong together" in text
    # What the file says, done by hand.
    listed = [line for line in text.splitlines() if re.fullmatch(r"\w+\.(csv|nml)", line)]
    for name in listed:
        newer = either.target / f"{name}.partial"
        if newer.exists():
            newer.rename(either.target / name)
    for path in either.target.iterdir():
        if path.name not in listed:
            path.unlink()
    assert either.state() == "new"


@pytest.mark.parametrize("option", ["--resume", "--quiet"])
def test_what_was_begun_is_completed_before_anything_else(either, option):
    for at in range(1, either.number("rename") + 1):
        either.reset()
        either.target.mkdir(parents=True, exist_ok=True)
        (either.target / "sweep.csv.partial").write_text("another run's")
        either.run(call="rename", at=at, errno=faults.KILL, under="try/d")
        assert either.state() == ("told" if at > 1 else either.before)
        # The results of that run are there though the next one fails.
        done = either.run("try", option, call="write", at=1, errno=errno.ENOSPC, under="try/d")
        resumed = at > 1 and option == "--resume"
        assert (done.returncode == 0) == resumed
        assert ("installed the results" in done.stderr) == resumed
        assert either.state() == ("new" if at > 1 else either.before)
        either.mend(option)


def test_a_file_of_intent_that_cannot_be_true_is_refused(stand):
    stand.reset()
    for text, words in [("", "lists no results"), ("x\nsweep.csv\n", "sweep.csv is missing")]:
        (stand.target / faults.INTENT).write_text(text)
        before = {path.name: path.read_bytes() for path in stand.target.iterdir()}
        done = stand.run("try")
        assert done.returncode == 1
        assert words in done.stderr
        assert {path.name: path.read_bytes() for path in stand.target.iterdir()} == before


# --- What is no file


def make_fifo(path, _):
    os.mkfifo(path)


def make_link(path, elsewhere):
    elsewhere.write_text("precious")
    path.symlink_to(elsewhere)


def make_dangling_link(path, elsewhere):
    elsewhere.unlink(missing_ok=True)
    path.symlink_to(elsewhere)


@pytest.mark.parametrize("make", [make_fifo, make_link, make_dangling_link])
@pytest.mark.parametrize("name", ["journal", "curve.csv", "classical.csv", "summary.nml",
                                  faults.INTENT])
def test_what_is_no_file_is_refused_and_not_opened(stand, make, name):
    for options in [(), ("--resume",)]:
        stand.reset()
        elsewhere = stand.folder / "elsewhere"
        make(stand.target / f"{name}.partial", elsewhere)
        done = stand.run("try", *options)
        assert done.returncode == 1
        words = "not a file but a link, a pipe or a device; move away"
        assert f"{name}.partial: {words}" in done.stderr
        assert stand.state() == "old"
        if make is make_link:
            assert elsewhere.read_text() == "precious"
        elsewhere.unlink(missing_ok=True)
        (stand.target / f"{name}.partial").unlink(missing_ok=True)
        stand.mend()


# --- The journal


@pytest.mark.slow
def test_the_journal_is_put_on_the_disk_every_few_seconds(snapin_path, stand, tmp_path):
    (tmp_path / "d.nml").write_text(lennard_jones(0.2, loading=loading(4, 1, 1e-6)))
    env = dict(os.environ, OMP_NUM_THREADS="1", LD_PRELOAD=str(stand.library), FAULT_CALL="fsync",
               FAULT_UNDER="results/d", FAULT_LOG=str(tmp_path / "log"))
    with subprocess.Popen([snapin_path, "--quiet", "d.nml"], cwd=tmp_path, env=env) as process:
        time.sleep(5.5)
        process.send_signal(signal.SIGKILL)
    calls = [line.split("\t") for line in (tmp_path / "log").read_text().splitlines()]
    journal = [name for name, _, path, *_ in calls if path.endswith("journal.partial")]
    assert journal.count("fsync") == 2
    # The stand takes a call of its own for every byte; without it there are twenty a second.
    assert journal.count("write") > 20
    # Its names need that once.
    synced = [os.path.normpath(path) for name, _, path, *_ in calls if name == "fsync"]
    assert synced[1:3] == ["results/d", "results"]
    assert {*synced[:1], *synced[3:]} == {"results/d/journal.partial"}
