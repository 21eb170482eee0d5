"""Runs that are stopped or killed and then continued, and their journals as bytes."""

import random
import shutil
import signal
import struct
import subprocess
import time

import pytest
from conftest import ROOT
from support import faults
from support.processes import threaded
from support.scenes import lennard_jones, loading

WORD = 8


def frames(journal):
    """The frames of a journal: its heading, then one frame for each record."""
    found, at = [], 0
    while at < len(journal):
        (held,) = struct.unpack_from("<q", journal, at)
        end = at + (3 + held) * WORD
        found.append(journal[at:end])
        at = end
    assert at == len(journal)
    return found


def checksum(words):
    """The checksum of 64-bit words, as in src/base/checksums.f90."""
    def added(value, halves):
        for half in halves:
            value = (value ^ half) * 0x5BD1E995 & 0xFFFFFFFF
            value ^= value >> 15
        return value

    def halves(some):
        return [half for word in some for half in (word & 0xFFFFFFFF, word >> 32)]

    whole = len(words) - len(words) % 4
    lanes = [added(0, halves(words[k:whole:4])) for k in range(4)]
    return added(added(len(words), halves(words[whole:])), lanes)


def sealed(frame):
    words = list(struct.unpack(f"<{len(frame) // WORD}Q", frame))
    words[1] = 0
    words[1] = checksum(words)
    return struct.pack(f"<{len(words)}Q", *words)


def heading(text):
    data = text.encode()
    data += b" " * (-len(data) % WORD)
    return sealed(struct.pack("<qqdq", 1 + len(data) // WORD, 0, 0.0, len(text)) + data)


def owner(frame):
    (length,) = struct.unpack_from("<q", frame, 3 * WORD)
    return frame[4 * WORD : 4 * WORD + length].decode()


def linked_id(file):
    """The first half of the linker's id of a program or library, as in headings."""
    note = struct.pack("<3I4s", 4, 20, 3, b"GNU")
    _, found, after = file.read_bytes().partition(note)
    assert found, f"{file} has no build id"
    return after[:8].hex()


def rows(lines):
    return [line for line in lines if not line.startswith(b"#")][1:]


class Bench:
    """One deck, run to the end without interruption, and once more with the journal kept."""

    def __init__(self, snapin, path, folder, text, threads=1, status=0):
        self.snapin, self.path, self.folder, self.threads = snapin, path, folder, threads
        self.status = status
        folder.mkdir(exist_ok=True)
        (folder / "deck.nml").write_text(text)
        done = self.run("whole")
        assert done.returncode == status, done.stderr
        self.whole = self.files("whole")
        self.library = faults.library(folder)
        self.journal = self.stop(b"")

    def run(self, out, *options, **kwargs):
        return self.snapin(
            "--out", out, *options, "deck.nml", cwd=self.folder, env=threaded(self.threads),
            **kwargs)

    def files(self, out):
        """The contents of results: tables to the byte, the summary without times."""
        found = {}
        for path in sorted((self.folder / out / "deck").iterdir()):
            lines = path.read_bytes().splitlines()
            found[path.name] = [line for line in lines if b"_seconds" not in line]
        return found

    def emptied(self, journal=None, out="cut"):
        """The folder of results, in which there is nothing, or a journal."""
        target = self.folder / out / "deck"
        target.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(target)
        (target / "unfinished").mkdir(parents=True)
        if journal is not None:
            (target / "unfinished/journal").write_bytes(journal)
        return target

    def resume(self, journal):
        self.emptied(journal)
        return self.run("cut", "--resume")

    def stop(self, journal):
        """The journal of a run that continues from a journal and is stopped at its end."""
        self.emptied(journal)
        # If nothing can be renamed, the run stops before its end.
        env = threaded(self.threads, LD_PRELOAD=str(self.library), FAULT_CALL="rename",
                       FAULT_AT="1", FAULT_ERRNO="5", FAULT_UNDER="cut/deck")
        done = self.snapin("--out", "cut", "--resume", "deck.nml", cwd=self.folder, env=env)
        assert done.returncode == 1, done.stderr
        return (self.folder / "cut/deck/unfinished/journal").read_bytes()

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
                env=threaded(self.threads), stderr=subprocess.DEVNULL) as process:
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)

    def check_killed(self, times, shortest, longest):
        """Kills a run again and again; the last run ends with the files of an undisturbed one."""
        rng = random.Random(4)
        self.emptied()
        for _ in range(times):
            self.kill(rng.uniform(shortest, longest), "--resume")
        assert self.run("cut", "--resume").returncode == self.status
        assert self.files("cut") == self.whole


SWEEP = lennard_jones(
    0.2, loading=loading(6, 0, 0.5), unloading={},
    sweep={"key": "force.hamaker", "from_": 1.0, "to": 100.0, "count": 9, "scale": "log"})


# The shortest of the decks with a cycle.
SHORT = (ROOT / "inputs/first.nml").read_text()


@pytest.fixture(scope="module")
def sweep(snapin, snapin_path, tmp_path_factory):
    """A sweep on two threads, for the modules that import it."""
    return Bench(snapin, snapin_path, tmp_path_factory.mktemp("sweep"), SWEEP, threads=2)


@pytest.fixture(scope="module")
def short(snapin, snapin_path, tmp_path_factory):
    """The shortest cycle, for the modules that import it."""
    return Bench(snapin, snapin_path, tmp_path_factory.mktemp("short"), SHORT)
