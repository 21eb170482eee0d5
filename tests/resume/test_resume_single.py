"""Claims about a run without a sweep that was interrupted: it is run again."""

import os

from support.interrupted import SHORT, Bench, short  # noqa: F401
from support.processes import threaded


def test_an_interrupted_run_is_run_again_and_that_is_said(short):
    for options in ([], ["--resume"]):
        target = short.emptied(short.journal)
        done = short.run("cut", *options)
        assert done.returncode == 0
        assert "an earlier run was interrupted; it is run again from the beginning" in done.stderr
        assert short.files("cut") == short.whole
        assert not (target / "unfinished").exists()


def test_what_another_deck_left_does_not_stop_a_run(short):
    short.emptied(short.journal[:100] + b"torn" + os.urandom(40))
    assert short.run("cut", "--resume").returncode == 0
    assert short.files("cut") == short.whole


def test_a_killed_run_leaves_the_files_of_an_undisturbed_one_at_last(short):
    short.check_killed(4, 0.005, 0.06)


def test_a_run_that_could_not_write_says_to_run_it_again(short):
    short.emptied()
    env = threaded(1, LD_PRELOAD=str(short.library), FAULT_CALL="rename", FAULT_AT="1",
                   FAULT_ERRNO="5", FAULT_UNDER="cut/deck")
    done = short.snapin("--out", "cut", "deck.nml", cwd=short.folder, env=env)
    assert done.returncode == 1
    assert "then run it again" in done.stderr and "--resume" not in done.stderr


def test_resume_leaves_a_finished_run_as_it_is(snapin, snapin_path, tmp_path):
    bench = Bench(snapin, snapin_path, tmp_path, SHORT)
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "whole/deck").iterdir()}
    done = bench.run("whole", "--resume")
    assert done.returncode == 0 and "nothing to do" in done.stderr
    assert before == {path: path.stat().st_mtime_ns for path in before}
