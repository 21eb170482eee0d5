"""Claims about runs that are killed, gone on with, or in each other's way."""

import fcntl
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import time

import f90nml
import pytest
from conftest import ROOT
from support.scenes import deck, exponential, lennard_jones, loading

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
    """The checksum of 64-bit words, as src/resume/byte_record.f90 has it."""
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


def rows(lines):
    """The rows of a table, without what comes before them."""
    return [line for line in lines if not line.startswith(b"#")][1:]


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
        (folder / "cut/deck").mkdir(parents=True, exist_ok=True)
        self.journal = self.stop(b"")

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

    def stop(self, journal):
        """The journal of the run that goes on from a journal and is stopped at its end."""
        (self.folder / "cut/deck/summary.nml").unlink(missing_ok=True)
        (self.folder / "cut/deck/summary.nml").mkdir()
        (self.folder / "cut/deck/journal.partial").write_bytes(journal)
        try:
            assert self.run("cut", "--resume").returncode == 1
        finally:
            (self.folder / "cut/deck/summary.nml").rmdir()
        return (self.folder / "cut/deck/journal.partial").read_bytes()

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
    found = rows(sweep.files("cut")["sweep.csv"])
    assert [i + 1 for i, row in enumerate(found) if b",1.2345" in row] == [index]


def test_a_damaged_record_is_computed_again(sweep):
    first, *cases = frames(sweep.journal)
    changed = bytearray(cases[4])
    changed[6 * WORD : 7 * WORD] = struct.pack("<d", 12345.0)
    sweep.check(first + b"".join(cases[:4]) + bytes(changed))


def test_what_was_torn_is_cut_off(sweep):
    first, *cases = frames(sweep.journal)
    ended = sweep.stop(first + b"".join(cases[:7]) + bytes(100 * len(cases[0])))
    assert sorted(len(part) for part in frames(ended)) == sorted(map(len, frames(sweep.journal)))


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
    lines = (tmp_path / "results/deck/curve.csv").read_text().splitlines()
    header, *rows = [line for line in lines if not line.startswith("#")]
    assert len(rows) == 5


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


@pytest.mark.parametrize("away", ["removed", "moved", "a file removed"])
def test_a_run_whose_folder_is_gone_publishes_nothing_and_touches_no_other(
    snapin_path, tmp_path, away
):
    (tmp_path / "deck.nml").write_text(lennard_jones(0.87, loading=loading(9, -3, 0.002)))
    folder = tmp_path / "results/deck"
    folder.mkdir(parents=True)
    (folder / "summary.nml").write_text("of an earlier run")
    with subprocess.Popen([snapin_path, "deck.nml"], cwd=tmp_path, env=environment(1),
                          stderr=subprocess.PIPE, text=True) as process:
        while not (folder / "curve.csv.partial").exists():
            assert process.poll() is None, process.communicate()[1]
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        assert (folder / "journal.partial").exists()
        if away == "moved":
            folder.rename(tmp_path / "elsewhere")
        elif away == "removed":
            shutil.rmtree(folder)
        else:
            (folder / "curve.csv.partial").unlink()
        # Another run begins there.
        folder.mkdir(exist_ok=True)
        others = {"curve.csv.partial": "x", "summary.nml.partial": "y", "journal.partial": "z",
                  "classical.csv": "t"}
        if away == "a file removed":
            others = {"summary.nml": "of an earlier run"}
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
        del others["summary.nml.partial"]
        assert {name: (folder / name).read_text() for name in others} == others
        assert all(p.name == "summary.nml" or p.name.endswith(".partial")
                   for p in (tmp_path / "elsewhere").iterdir())
        assert (tmp_path / "elsewhere/summary.nml").read_text() == "of an earlier run"


# --- Cycles

UNIFORM = {"grid": "uniform", "nodes": 120, "r_max": 12.0}
CYCLES = {
    "first": (ROOT / "inputs/first.nml").read_text(),
    "two turning points, strong adhesion": lennard_jones(
        8.7, loading=loading(14, -4, 1), unloading={"from_": [2.0, -4.0]},
        profiles={"h0": [2.0, -2.0]},
    ),
    "the paper's grid and rule": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, profiles={"h0": [1.0]},
        numerics={**UNIFORM, "method": "mixing", "convergence": "displacement_change",
                  "displacement_tolerance": 1e-4},
    ),
    "uniform grid": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, numerics=UNIFORM,
    ),
    "newton": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, numerics={"method": "newton"},
    ),
    "repulsion": exponential(
        100, loading=loading(6, -6, 0.5), unloading={}, profiles={"h0": [0.0]},
    ),
    "stability beside path and cycle": lennard_jones(
        0.87, loading=loading(4, -1, 0.5), unloading={}, equilibrium_path={}, stability={},
        profiles={"h0": [1.0]},
    ),
    "no state at the end": lennard_jones(0.87, part="attractive", loading=loading(6, -1, 0.25)),
    "rigid": deck(
        bodies={"radius": 1.0, "rigid": True},
        force={"law": "lennard_jones", "hamaker": 50.0, "z0": 1.0},
        loading=loading(6, 1, 0.25), unloading={},
    ),
}
FAILS = ("the paper's grid and rule", "no state at the end")


@pytest.fixture(scope="module", params=CYCLES)
def cycle(request, snapin, snapin_path, tmp_path_factory):
    folder = tmp_path_factory.mktemp("cycle")
    return Bench(snapin, snapin_path, folder, CYCLES[request.param],
                 status=int(request.param in FAILS))


def test_a_cycle_goes_on_from_anywhere(cycle):
    parts = frames(cycle.journal)
    rng = random.Random(3)
    for count in rng.sample(range(1, len(parts)), 4) + [len(parts)]:
        cycle.check(b"".join(parts[:count]))
    # In the middle of a record, or of the heading.
    for size in [len(parts[0]) // 2] + rng.sample(range(len(cycle.journal)), 2):
        cycle.check(cycle.journal[:size])


@pytest.mark.long
def test_a_cycle_goes_on_from_any_record(cycle):
    parts = frames(cycle.journal)
    for count in range(len(parts) + 1):
        cycle.check(b"".join(parts[:count]))


def test_a_killed_cycle_goes_on_again_and_again(cycle):
    rng = random.Random(4)
    assert cycle.resume(b"").returncode == cycle.status
    target = cycle.folder / "cut/deck"
    for path in target.iterdir():
        path.unlink()
    for _ in range(4):
        cycle.kill(rng.uniform(0.02, 0.15), "--resume")
    assert cycle.run("cut", "--resume").returncode == cycle.status
    assert cycle.files("cut") == cycle.whole


def test_a_cycle_adds_only_what_its_journal_lacks(cycle):
    parts = frames(cycle.journal)
    begun = b"".join(parts[: 2 * len(parts) // 3])
    ended = cycle.stop(begun + parts[-1][:-WORD])
    assert ended.startswith(begun)
    # The same records but for the times they were made at.
    assert [len(part) for part in frames(ended)] == [len(part) for part in parts]


SHORT = CYCLES["first"]


@pytest.fixture(scope="module")
def short(snapin, snapin_path, tmp_path_factory):
    return Bench(snapin, snapin_path, tmp_path_factory.mktemp("short"), SHORT)


def test_another_number_of_threads_is_refused_in_a_cycle(snapin, snapin_path, tmp_path):
    bench = Bench(snapin, snapin_path, tmp_path, lennard_jones(0.2, loading=loading(6, 5, 0.5)))
    bench.threads = 2
    done = bench.resume(bench.journal)
    assert done.returncode == 1
    assert "set OMP_NUM_THREADS=1" in done.stderr
    assert (tmp_path / "cut/deck/journal.partial").read_bytes() == bench.journal


def test_times_of_a_run_that_was_interrupted_are_those_of_all_its_parts(short):
    parts = frames(short.journal)
    late = bytearray(parts[-1])
    late[2 * WORD : 3 * WORD] = struct.pack("<d", 1000.0)
    began = time.monotonic()
    assert short.resume(b"".join(parts[:-1]) + sealed(bytes(late))).returncode == 0
    taken = time.monotonic() - began
    cost = f90nml.read(short.folder / "cut/deck/summary.nml")["cost"]
    assert 1000 < cost["wall_seconds"] <= 1000 + taken
    assert short.resume(b"".join(parts[:-1])).returncode == 0
    cost = f90nml.read(short.folder / "cut/deck/summary.nml")["cost"]
    assert cost["wall_seconds"] >= cost["kernel_seconds"] + cost["solve_seconds"]
    assert cost["solve_seconds"] > 0


# --- Where files cannot be written

def empty(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        path.unlink()


def check_stopped(bench, done, folder, words):
    """A run that could not write: told, partial by name, and nothing that looks complete."""
    assert done.returncode == 1, done.stderr
    assert words in done.stderr
    names = [path.name for path in folder.iterdir()]
    assert names
    assert [name for name in names if not name.endswith(".partial")] == []


@pytest.mark.parametrize("name", ["short", "sweep"])
def test_a_limit_on_the_size_of_files_stops_a_run_that_then_goes_on(name, request):
    bench = request.getfixturevalue(name)
    folder = bench.folder / "cut/deck"
    largest = len(bench.journal)
    for limit in (0, 100, 1500, 2500, largest // 2, largest - 1):
        empty(folder)

        def limited(limit=limit):
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        done = bench.run("cut", preexec_fn=limited)
        check_stopped(bench, done, folder, "File too large; raise the limit")
        if limit == largest // 2:
            # What could not be kept is not computed either.
            (table,) = [*folder.glob("curve.csv.partial"), *folder.glob("sweep.csv.partial")]
            whole = rows(bench.whole[table.name[: -len(".partial")]])
            assert len(rows(table.read_bytes().splitlines())) < 0.8 * len(whole)
        assert bench.run("cut", "--resume").returncode == 0
        assert bench.files("cut") == bench.whole


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
        assert "going on" in done.stderr
        assert short.files(tmp_path) == short.whole
    finally:
        subprocess.run(["umount", tmp_path], check=True)


def test_results_of_an_earlier_run_outlive_one_that_cannot_write(short):
    folder = short.folder / "cut/deck"
    empty(folder)
    assert short.run("cut").returncode == 0

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000))

    done = short.run("cut", preexec_fn=limited)
    assert done.returncode == 1
    found = short.files("cut")
    assert {name: found[name] for name in short.whole} == short.whole
    assert "journal.partial" in found


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
    folder = short.folder / "cut/deck"
    empty(folder)
    # There is something to say while files are open.
    begun = b"".join(frames(short.journal)[:9])
    for options in [("--resume",), ()]:
        (folder / "journal.partial").write_bytes(begun)
        done = short.run("cut", *options, preexec_fn=close(*closed))
        assert done.returncode == 0
        assert short.files("cut") == short.whole


def test_a_closed_pipe_or_a_full_terminal_log_does_not_end_a_run(short):
    reader, writer = os.pipe()
    os.close(reader)
    full = os.open("/dev/full", os.O_WRONLY)
    try:
        for stream in (writer, full):
            empty(short.folder / "cut/deck")
            done = subprocess.run(
                [short.path, "--out", "cut", "--resume", "deck.nml"], cwd=short.folder,
                env=environment(1), stderr=stream, check=False,
            )
            assert done.returncode == 0
            assert short.files("cut") == short.whole
    finally:
        os.close(writer)
        os.close(full)
