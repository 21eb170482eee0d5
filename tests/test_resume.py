"""Claims about runs that are killed, gone on with, or in each other's way."""

import fcntl
import os
import random
import signal
import struct
import subprocess
import time

import pytest
from scenes import lennard_jones, loading

WORD = 8


# --- Journals as bytes


def frames(journal):
    """The frames of a journal: its heading, then one a record."""
    found, at = [], 0
    while at < len(journal):
        (held,) = struct.unpack_from("<q", journal, at)
        end = at + (3 + held) * WORD
        found.append(journal[at:end])
        at = end
    assert at == len(journal)
    return found


def checksum(words):
    """The checksum of 64-bit words, as src/packing.f90 has it."""
    value = len(words)
    for word in words:
        for half in (word & 0xFFFFFFFF, word >> 32):
            value = (value ^ half) * 0x5BD1E995 & 0xFFFFFFFF
            value ^= value >> 15
    return value


def sealed(frame):
    """A frame with the checksum that belongs to it."""
    words = list(struct.unpack(f"<{len(frame) // WORD}Q", frame))
    words[1] = 0
    words[1] = checksum(words)
    return struct.pack(f"<{len(words)}Q", *words)


def heading(text):
    """The frame of a heading."""
    data = text.encode()
    data += b" " * (-len(data) % WORD)
    return sealed(struct.pack("<qqdq", 1 + len(data) // WORD, 0, 0.0, len(text)) + data)


def owner(frame):
    """The text of a heading."""
    (length,) = struct.unpack_from("<q", frame, 3 * WORD)
    return frame[4 * WORD : 4 * WORD + length].decode()


# --- Runs


def environment(threads):
    return dict(os.environ, OMP_NUM_THREADS=str(threads), OPENBLAS_NUM_THREADS=str(threads))


class Bench:
    """One deck, run to the end in one go, and once more with the journal kept."""

    def __init__(self, snapin, path, folder, text, threads=1, status=0):
        self.snapin, self.path, self.folder, self.threads = snapin, path, folder, threads
        self.status = status
        folder.mkdir(exist_ok=True)
        (folder / "deck.nml").write_text(text)
        done = self.run("whole")
        assert done.returncode == status, done.stderr
        self.whole = self.files("whole")
        # Where the summary cannot get its name the run stops short of the end.
        (folder / "cut/deck/summary.nml").mkdir(parents=True)
        stopped = self.run("cut")
        assert stopped.returncode == 1
        assert "then go on with --resume" in stopped.stderr
        self.journal = (folder / "cut/deck/journal.partial").read_bytes()
        (folder / "cut/deck/summary.nml").rmdir()

    def run(self, out, *options, **kwargs):
        return self.snapin(
            "--out", out, *options, "deck.nml", cwd=self.folder, env=environment(self.threads),
            **kwargs
        )

    def files(self, out):
        """What results say: tables to the byte, the summary without times."""
        found = {}
        for path in sorted((self.folder / out / "deck").iterdir()):
            lines = path.read_bytes().splitlines()
            found[path.name] = [line for line in lines if b"_seconds" not in line]
        return found

    def resume(self, journal, out="cut"):
        """The run that goes on from a journal."""
        target = self.folder / out / "deck"
        target.mkdir(parents=True, exist_ok=True)
        for path in target.iterdir():
            path.unlink()
        (target / "journal.partial").write_bytes(journal)
        return self.run(out, "--resume")

    def check(self, journal):
        done = self.resume(journal)
        assert done.returncode == self.status, done.stderr
        found = self.files("cut")
        assert list(found) == list(self.whole)
        for name, lines in self.whole.items():
            assert found[name] == lines, name

    def kill(self, delay, *options):
        """Starts the program and kills it after a delay [s]."""
        with subprocess.Popen(
            [self.path, "--out", "cut", *options, "deck.nml"], cwd=self.folder,
            env=environment(self.threads), stderr=subprocess.DEVNULL,
        ) as process:
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)


SWEEP = lennard_jones(
    0.2, loading=loading(6, 0, 0.5), unloading={},
    sweep={"key": "force.hamaker", "from_": 1.0, "to": 100.0, "count": 9, "scale": "log"},
)


@pytest.fixture(scope="module")
def sweep(snapin, snapin_path, tmp_path_factory):
    return Bench(snapin, snapin_path, tmp_path_factory.mktemp("sweep"), SWEEP, threads=2)


# --- Sweeps


def test_a_sweep_goes_on_from_any_record(sweep):
    parts = frames(sweep.journal)
    assert len(parts) == 10
    for count in range(len(parts) + 1):
        sweep.check(b"".join(parts[:count]))


def test_cases_count_in_whatever_order_they_were_completed(sweep):
    first, *cases = frames(sweep.journal)
    random.Random(1).shuffle(cases)
    for count in (1, 4, 8):
        sweep.check(first + b"".join(cases[:count]))


def test_a_complete_case_is_not_computed_again(sweep):
    first, *cases = frames(sweep.journal)
    # The index, whether it converged, how many numbers, sigma, ...
    changed = bytearray(cases[4])
    changed[6 * WORD : 7 * WORD] = struct.pack("<d", 12345.0)
    assert sweep.resume(first + sealed(bytes(changed))).returncode == 0
    (index,) = struct.unpack_from("<q", changed, 3 * WORD)
    rows = [line for line in sweep.files("cut")["sweep.csv"] if not line.startswith(b"#")][1:]
    assert [i + 1 for i, row in enumerate(rows) if b",1.2345" in row] == [index]


def test_a_damaged_record_is_computed_again(sweep):
    first, *cases = frames(sweep.journal)
    changed = bytearray(cases[4])
    changed[6 * WORD : 7 * WORD] = struct.pack("<d", 12345.0)
    sweep.check(first + b"".join(cases[:4]) + bytes(changed))


def test_the_number_of_threads_may_change_between_the_parts_of_a_sweep(sweep):
    sweep.threads = 1
    try:
        assert sweep.resume(b"".join(frames(sweep.journal)[:4])).returncode == 0
        assert sweep.files("cut")["sweep.csv"] == sweep.whole["sweep.csv"]
    finally:
        sweep.threads = 2


def test_a_killed_sweep_goes_on_again_and_again(sweep):
    rng = random.Random(2)
    (sweep.folder / "cut/deck/journal.partial").unlink(missing_ok=True)
    (sweep.folder / "cut/deck/summary.nml").unlink(missing_ok=True)
    for _ in range(6):
        sweep.kill(rng.uniform(0.0, 0.15), "--resume")
    assert sweep.run("cut", "--resume").returncode == 0
    assert sweep.files("cut") == sweep.whole


# --- Whose journal it is


def changes(text):
    """Changed decks, and what is said of them."""
    lines = text.splitlines(keepends=True)
    without = "".join(line for line in lines if not line.startswith("&unloading"))
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
            assert "cannot go on" in done.stderr
            assert words in done.stderr
            assert "without --resume" in done.stderr
            target = sweep.folder / "cut/deck"
            assert [p.name for p in target.iterdir()] == ["journal.partial"]
            assert (target / "journal.partial").read_bytes() == journal
    finally:
        path.write_text(SWEEP)


@pytest.mark.parametrize("line, advice", [("program: ", "go on with that one"),
                                          ("libraries: ", "go on with that one")])
def test_another_program_is_refused(sweep, line, advice):
    first, *cases = frames(sweep.journal)
    lines = owner(first).splitlines(keepends=True)
    changed = "".join(line + "0.0.0\n" if each.startswith(line) else each for each in lines)
    assert changed != owner(first)
    done = sweep.resume(heading(changed) + cases[0])
    assert done.returncode == 1
    assert "0.0.0" in done.stderr
    assert advice in done.stderr
    # The heading is read as it was written.
    sweep.check(heading(owner(first)) + cases[0])


# --- With nothing to go on with


def test_resume_without_anything_to_resume_begins_at_the_beginning_and_says_so(sweep):
    done = sweep.run("fresh", "--resume")
    assert done.returncode == 0
    assert "no interrupted run to go on with" in done.stderr
    assert sweep.files("fresh") == sweep.whole


def test_resume_leaves_finished_results_as_they_are(sweep):
    target = sweep.folder / "whole/deck"
    before = {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in target.iterdir()}
    done = sweep.run("whole", "--resume")
    assert done.returncode == 0
    assert "complete since an earlier run" in done.stderr
    after = {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in target.iterdir()}
    assert after == before


def test_resume_keeps_the_exit_status_of_a_finished_run_that_failed(snapin, tmp_path):
    numerics = {"method": "mixing", "max_iterations": 3, "nodes": 200}
    text = lennard_jones(0.87, loading=loading(5, 3, 1), numerics=numerics)
    (tmp_path / "deck.nml").write_text(text)
    assert snapin("deck.nml", cwd=tmp_path).returncode == 1
    done = snapin("--resume", "deck.nml", cwd=tmp_path)
    assert done.returncode == 1
    assert "complete since an earlier run" in done.stderr


def test_resume_runs_a_deck_whose_results_are_of_another(snapin, tmp_path):
    (tmp_path / "deck.nml").write_text(lennard_jones(0.87, loading=loading(6, 5, 0.5)))
    assert snapin("deck.nml", cwd=tmp_path).returncode == 0
    (tmp_path / "deck.nml").write_text(lennard_jones(0.87, loading=loading(6, 4, 0.5)))
    assert snapin("--resume", "deck.nml", cwd=tmp_path).returncode == 0
    assert len((tmp_path / "results/deck/curve.csv").read_text().splitlines()) == 12 + 5


def test_without_resume_what_was_interrupted_is_dropped_and_that_is_said(sweep):
    target = sweep.folder / "cut/deck"
    for path in target.iterdir():
        path.unlink()
    (target / "journal.partial").write_bytes(b"".join(frames(sweep.journal)[:3]))
    done = sweep.run("cut")
    assert done.returncode == 0
    assert "starting over" in done.stderr
    assert sweep.files("cut") == sweep.whole


# --- Two runs, one folder


@pytest.mark.parametrize("options", [[], ["--resume"]])
def test_a_second_run_is_refused_and_touches_nothing(sweep, options):
    target = sweep.folder / "cut/deck"
    for path in target.iterdir():
        path.unlink()
    (target / "journal.partial").write_bytes(b"".join(frames(sweep.journal)[:3]))
    (target / "curve.csv.partial").write_text("x")
    before = {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in target.iterdir()}
    folder = os.open(target, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        done = sweep.run("cut", *options)
    finally:
        os.close(folder)
    assert done.returncode == 1
    assert "another run is writing" in done.stderr
    assert "--out" in done.stderr
    after = {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in target.iterdir()}
    assert after == before
    # The lock is gone with its holder.
    assert sweep.run("cut", *options).returncode == 0
