"""Claims about results when system calls fail, runs are killed, or the power does (faults.py)."""

import errno
import os
import signal
import subprocess
import time

import pytest
from support import faults
from support.interrupted import frames, sweep  # noqa: F401 (`sweep` is a fixture)
from support.processes import threaded
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


def torn(stand, at):
    """What is in the folder when a renaming fails: the old summary is gone before the first."""
    return "none" if at == 1 and not stand.old else faults.TORN


# --- A sample; `verify.sh faults` tries every call with every error


@pytest.mark.parametrize("code", [faults.KILL, errno.EIO], ids=["killed", "EIO"])
def test_a_rename_that_fails_leaves_one_set_of_results_or_says_so(either, code):
    for at in range(1, either.number("rename") + 1):
        end = either.attempt("rename", at, code)
        if code:
            assert end == f"status 1, {torn(either, at)}"


@pytest.mark.slow
@pytest.mark.parametrize("code", [faults.KILL, errno.ENOSPC], ids=["killed", "ENOSPC"])
def test_no_failing_call_leaves_results_that_are_not_one_set(either, code):
    for at in range(1, either.number("any") + 1, 7):
        either.attempt("any", at, code)


def test_a_disk_that_fails_for_good_amid_the_renames_is_told_and_mended(either):
    number = either.number("rename")
    ends = [either.attempt("rename", at, errno.EIO, lasts=True) for at in range(1, number + 1)]
    assert ends == [f"status 1, {torn(either, at)}" for at in range(1, number + 1)]


@pytest.mark.slow
def test_a_power_failure_at_any_call_leaves_one_set_of_results_or_says_so(either):
    ends = faults.power_failures(either, every=5)
    assert ends[either.before] and ends[faults.TORN] and ends["new"]


@pytest.mark.long
def test_every_call_may_fail(either):
    broken = [line for *_, bad in faults.campaign(either) for line in bad]
    assert not broken
    ends = faults.power_failures(either)
    assert ends[either.before] and ends["new"] and ends[faults.TORN]


@pytest.mark.parametrize("code", [faults.KILL, errno.EIO], ids=["killed", "EIO"])
def test_a_run_after_one_that_was_stopped_amid_the_renames_may_be_stopped_too(either, code):
    """Nothing of the first run is taken for the second's, whatever that leaves."""
    def stop():
        either.reset()
        either.run(call="rename", at=2, errno=faults.KILL, under="try/d")
        assert either.state() == faults.TORN

    stop()
    log = either.folder / "second.log"
    either.run("try", "--resume", call="any", under="try/d", log=log)
    calls = [line.split("\t")[0] for line in log.read_text().splitlines()]
    for call in ("rename", "fsync"):
        for at in range(1, min(calls.count(call), 8) + 1):
            stop()
            either.run("try", "--resume", call=call, at=at, errno=code, under="try/d")
            either.state()
            either.mend()


def test_files_wait_for_the_disk_no_more_often_than_the_order_of_steps_needs(either):
    # Each file, the folders of new and of final names, and three times again the second one.
    assert either.number("fsync") == len(either.new) + 2 + 3


def test_every_file_is_on_the_disk_before_it_gets_its_name(either):
    """The old summary is gone for good before the first new file, which all precede the summary."""
    synced, waiting, renamed = set(), set(), []
    for name, _, path, *rest in either.log()[:-1]:
        file = path.removeprefix("try/d").removeprefix("/")
        if name in ("write", "truncate"):
            synced.discard(file)
        elif name == "create":
            waiting.add(file)
        elif name == "fsync" and file in ("", faults.UNFINISHED):
            waiting = {each for each in waiting if each.rpartition("/")[0] != file}
        elif name == "fsync":
            synced.add(file)
        elif name == "unlink" and not renamed and file == "summary.nml":
            waiting.add(file)
        elif name == "rename":
            assert file in synced and file not in waiting
            assert "summary.nml" not in waiting
            if rest[0] == "summary.nml":
                assert not waiting & {*renamed}
            waiting.add(rest[0])
            renamed.append(rest[0])
    assert sorted(renamed) == sorted(either.new)
    assert renamed[-1] == "summary.nml"


# --- What a reader is told


def test_a_folder_that_was_left_amid_the_renames_can_be_completed_by_hand(either):
    """All new files are in the folder or in `unfinished`, as the message says."""
    either.reset()
    done = either.run(call="rename", at=2, errno=errno.EIO, under="try/d")
    assert "not all are in place: the others are in try/d/unfinished" in done.stderr
    for path in (either.target / faults.UNFINISHED).iterdir():
        if path.name != "journal":
            path.rename(either.target / path.name)
    for name in {*either.old} - {*either.new}:
        (either.target / name).unlink(missing_ok=True)
    assert either.state() == "new"


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
@pytest.mark.parametrize("name", ["unfinished/journal", "unfinished/curve.csv", "curve.csv",
                                  "unfinished/summary.nml", "fit.nml", "summary.nml"])
def test_what_is_no_file_is_refused_and_not_opened(stand, make, name):
    for options in [(), ("--resume",), ("--check",)]:
        stand.reset()
        elsewhere = stand.folder / "elsewhere"
        (stand.target / name).parent.mkdir(exist_ok=True)
        (stand.target / name).unlink(missing_ok=True)
        make(stand.target / name, elsewhere)
        before = sorted(path.name for path in stand.target.rglob("*"))
        done = stand.run("try", *options)
        assert done.returncode == 2
        assert f"{name} is not a file but a link, a pipe or a device" in done.stderr
        assert sorted(path.name for path in stand.target.rglob("*")) == before
        if make is make_link:
            assert elsewhere.read_text() == "precious"
        elsewhere.unlink(missing_ok=True)
        (stand.target / name).unlink()
        stand.mend()


# --- The journal


@pytest.mark.slow
def test_the_journal_is_put_on_the_disk_every_few_seconds(snapin_path, stand, tmp_path):
    (tmp_path / "d.nml").write_text(lennard_jones(
        0.2, loading=loading(4, 1, 1e-2),
        sweep={"key": "force.hamaker", "from_": 1.0, "to": 2.0, "count": 10000}))
    env = dict(os.environ, OMP_NUM_THREADS="1", LD_PRELOAD=str(stand.library), FAULT_CALL="fsync",
               FAULT_UNDER="results/d", FAULT_LOG=str(tmp_path / "log"))
    with subprocess.Popen([snapin_path, "--quiet", "d.nml"], cwd=tmp_path, env=env) as process:
        time.sleep(5.5)
        process.send_signal(signal.SIGKILL)
    calls = [line.split("\t") for line in (tmp_path / "log").read_text().splitlines()]
    journal = [name for name, _, path, *_ in calls if path.endswith("unfinished/journal")]
    assert journal.count("fsync") == 2
    # The stand takes a call of its own for every byte; without it there are twenty a second.
    assert journal.count("write") > 20
    # Its names need that once.
    synced = [os.path.normpath(path) for name, _, path, *_ in calls if name == "fsync"]
    assert synced[1:4] == ["results/d/unfinished", "results/d", "results"]
    assert {*synced[:1], *synced[4:]} == {"results/d/unfinished/journal"}


def test_a_journal_that_can_be_read_once_and_not_again_stops_the_run(sweep):  # noqa: F811
    """Its cases were counted as there, and had no rows."""
    target = sweep.emptied(sweep.journal)
    fault = {"LD_PRELOAD": str(sweep.library), "FAULT_CALL": "read",
             "FAULT_UNDER": "unfinished/journal", "FAULT_ERRNO": str(errno.EIO)}
    # A record takes two calls, and the end one.
    once = 2 * len(frames(sweep.journal)) + 1
    done = sweep.snapin("--out", "cut", "--resume", "deck.nml", cwd=sweep.folder,
                        env=threaded(2, **fault, FAULT_AT=str(once + 5)))
    assert done.returncode == 1 and "cannot read cut/deck/unfinished/journal" in done.stderr
    assert not (target / "summary.nml").exists()
