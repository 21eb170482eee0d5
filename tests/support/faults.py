"""Runs in which a system call fails, or that are killed or lose power at a system call.

    faults.py [--every N]

tries every call (or every N-th), prints a table of the number of tries and of the ends of the
runs, and ends with status 1 if a promise of src/system/publication.f90 is broken.

A run is to replace the results of an older deck of the same name, or has a new folder. In every
case, files with final names are the old set (in a new folder: none) or the new set, or the folder
has no summary, and each file is of one of these sets; the same deck with --resume then leaves
exactly the files of an undisturbed run.
"""

import argparse
import collections
import errno
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from support import scenes

HERE = pathlib.Path(__file__).resolve().parent
UNFINISHED = "unfinished"
TORN = "no summary"
KILL = 0

RIGID = {"bodies": {"radius": 1.0, "rigid": True},
         "force": {"law": "lennard_jones", "hamaker": 50.0, "z0": 1.0}}
OLD = scenes.deck(**RIGID, loading=scenes.loading(6, 2, 1), profiles={"h0": [4.0]},
                  approximations={"count": 3})
NEW = scenes.deck(**RIGID, loading=scenes.loading(5, 1, 0.5), profiles={"h0": [2.0]},
                  classical={"count": 3})


class Broken(AssertionError):
    """A broken promise."""


def require(held, *what):
    if not held:
        raise Broken(" ".join(map(str, what)))


def contents(folder):
    """The contents of results: name -> bytes, the summary without times; not what is unfinished."""
    found = {}
    for path in folder.iterdir() if folder.is_dir() else ():
        if path.name == UNFINISHED:
            continue
        lines = path.read_bytes().splitlines(keepends=True)
        found[path.name] = b"".join(line for line in lines if b"_seconds" not in line)
    return found


def library(folder):
    """Makes the library that is loaded before the C library (faults.c)."""
    path = folder / "faults.so"
    subprocess.run([os.environ.get("CC", "cc"), "-O1", "-shared", "-fPIC", "-o", path,
                    HERE / "faults.c", "-ldl"], check=True)
    return path


class Stand:
    """The old and the new results, and a folder where the new results are to replace the old ones.

    Without `old` this folder does not exist before the run.
    """

    def __init__(self, snapin, folder, old=OLD):
        self.snapin, self.folder = snapin, pathlib.Path(folder)
        self.library = library(self.folder)
        self.target = self.folder / "try/d"
        self.before = "old" if old else "none"
        for name, text in (("old", old), ("new", NEW)):
            if text:
                (self.folder / "d.nml").write_text(text)
                done = self.run(name)
                require(done.returncode == 0, done.stderr)
        self.old, self.new = (contents(self.folder / name / "d") for name in ("old", "new"))
        require(self.old != self.new, "two decks of the same results")

    def run(self, out="try", *options, **fault):
        """Runs the program with a fault given by keywords: call="rename", at=3, errno=5."""
        env = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        if fault:
            env["LD_PRELOAD"] = str(self.library)
            env.update({f"FAULT_{key.upper()}": str(value) for key, value in fault.items()})
        return subprocess.run([self.snapin, "--out", out, *options, "d.nml"], cwd=self.folder,
                              env=env, capture_output=True, text=True, timeout=60, check=False)

    def reset(self):
        shutil.rmtree(self.target.parent, ignore_errors=True)
        if self.old:
            shutil.copytree(self.folder / "old/d", self.target)

    def log(self):
        """The calls on files of an undisturbed run, as lists of fields."""
        self.reset()
        path = self.folder / "calls.log"
        path.unlink(missing_ok=True)
        done = self.run(call="any", under="try/d", log=path)
        require(done.returncode == 0, done.stderr)
        return [line.split("\t") for line in path.read_text().splitlines()]

    def number(self, call):
        """The number of calls of a kind in a run."""
        self.reset()
        path = self.folder / "count.log"
        path.unlink(missing_ok=True)
        self.run(call=call, at=0, under="try/d", log=path)
        return int(path.read_text().splitlines()[-1].split("\t")[1])

    def state(self):
        """The state of the folder: 'old' or 'none', 'new', or 'no summary'."""
        found = contents(self.target)
        if found in (self.old, self.new):
            return self.before if found == self.old else "new"
        require("summary.nml" not in found, "neither old nor new:", sorted(found))
        for name, data in found.items():
            require(data in (self.old.get(name), self.new.get(name)), name, "is not whole")
        return TORN

    def mend(self, *options):
        """The next run leaves the files of an undisturbed run, and no other file."""
        done = self.run("try", *(options or ["--resume"]))
        require(done.returncode == 0, "no way on:", done.stderr)
        require(contents(self.target) == self.new, "not the same after --resume")
        left = sorted(path.name for path in self.target.iterdir())
        require(left == sorted(self.new), "left behind:", left)

    def attempt(self, call, at, code, lasts=False):
        """Makes a run with one fault; returns its end."""
        self.reset()
        fault = {"call": call, "at": at, "errno": code, "under": "try/d"}
        done = self.run(**fault, **({"lasts": 1} if lasts else {}))
        if code == KILL:
            require(done.returncode in (0, -9), done.returncode, done.stderr)
        else:
            require(done.returncode in (0, 1, 2), done.returncode, done.stderr)
        state = self.state()
        # A file that cannot be read may be another's; without `fstat` nothing shows what it is.
        if done.returncode == 2:
            require("cannot be read" in done.stderr or call == "fstat", done.stderr)
            require(state == self.before, "refused, and changed")
        if done.returncode == 0:
            require(state == "new", "status 0 and no new results")
        if done.returncode == 1:
            require(done.stderr.strip(), "no message")
            told = "not all are in place" in done.stderr
            # In a new folder nothing may be in place.
            require(told or state != TORN, state, done.stderr)
            require(not told or state in (TORN, "none"), state, done.stderr)
        self.mend()
        ends = {0: "ended well", 1: "status 1", 2: "status 2", -9: "killed"}
        return f"{ends[done.returncode]}, {state}"


# --- Power failure


class Inode:
    """The content of a file: the operations on it, and the number of them that are on the disk."""

    def __init__(self, data=b""):
        self.steps, self.synced = [("write", data)], 1

    def after(self, count):
        data = b""
        for kind, value in self.steps[:count]:
            data = data[:value] if kind == "truncate" else data + value
        return data


def power_failures(stand, every=1, seed=1):
    """Makes the folders that a power failure after each call of a run may leave, and repairs them.

    Data that were not synchronised may be on the disk or not: contents whole, in part or not at
    all; names in any combination. Counts the folders with a whole set and those reported.
    """
    calls = stand.log()[:-1]
    rng = random.Random(seed)
    found = collections.Counter()
    for stop in [*range(0, len(calls), every), len(calls)]:
        for keep in ("nothing", "all names", "some"):
            lay_out(stand, calls[:stop], keep, rng)
            state = stand.state()
            require(state == "new" or stop < len(calls), "lost after the run's end")
            found[state] += 1
            stand.mend()
    return found


def lay_out(stand, calls, keep, rng):
    """The folder as it may be on the disk after `calls`."""
    old = stand.folder / "old/d"
    disk = {path.name: Inode(path.read_bytes()) for path in (old.iterdir() if stand.old else ())}
    now, waiting, lasting = dict(disk), [], bool(stand.old)
    for name, _, path, *rest in calls:
        # Names below the folder of results, "" for the folder itself.
        file = path.removeprefix("try/d").removeprefix("/")
        if name == "fsync" and file == "..":
            lasting = True
        elif name == "create" and file not in now:
            now[file] = Inode(b"")
            waiting.append(("link", file, now[file]))
        elif name == "write":
            now[file].steps.append(("write", bytes.fromhex(rest[0])))
        elif name == "truncate":
            now[file].steps.append(("truncate", int(rest[0])))
        elif name == "rename":
            now[rest[0]] = now.pop(file)
            waiting.append(("rename", file, rest[0]))
        elif name == "unlink" and file in now:
            del now[file]
            waiting.append(("unlink", file, None))
        elif name == "fsync" and file in ("", UNFINISHED):
            lasting_now = [step for step in waiting if synced_with(file, step)]
            waiting = [step for step in waiting if step not in lasting_now]
            apply(lasting_now, disk)
        elif name == "fsync" and file in now:
            now[file].synced = len(now[file].steps)
    apply([step for step in waiting
           if keep == "all names" or (keep == "some" and rng.random() < 0.5)], disk)
    shutil.rmtree(stand.target, ignore_errors=True)
    if not lasting and (keep == "nothing" or (keep == "some" and rng.random() < 0.5)):
        return
    (stand.target / UNFINISHED).mkdir(parents=True)
    for file, inode in disk.items():
        count = inode.synced
        if keep == "some":
            count = rng.randint(count, len(inode.steps))
        (stand.target / file).write_bytes(inode.after(count))


def synced_with(folder, step):
    """Whether a change of names is on the disk when a folder is; a renamed file has a new place."""
    kind, file, other = step
    return (other if kind == "rename" else file).rpartition("/")[0] == folder


def apply(steps, disk):
    """Makes changes of names on the disk."""
    for kind, file, other in steps:
        if kind == "link":
            disk[file] = other
        elif kind == "rename" and file in disk:
            disk[other] = disk.pop(file)
        elif kind == "unlink":
            disk.pop(file, None)


# --- The campaign

KINDS = ("mkdir", "open", "write", "fsync", "close", "rename", "unlink", "ftruncate", "fstat")
ERRORS = {"killed": KILL, "EIO": errno.EIO, "ENOSPC": errno.ENOSPC, "EACCES": errno.EACCES}


def campaign(stand, every=1):
    """Yields (call, event, number of tries, ends of the runs, broken promises)."""
    for call in KINDS:
        number = stand.number(call)
        if number == 0:
            continue
        for name, code in ERRORS.items():
            for lasts in (False, True) if name != "killed" else (False,):
                ends, broken = collections.Counter(), []
                points = range(1, number + 1, every)
                for at in points:
                    try:
                        ends[stand.attempt(call, at, code, lasts)] += 1
                    except (Broken, subprocess.TimeoutExpired) as problem:
                        broken.append(f"{call} {at} {name}: {problem}")
                yield call, name + (" from then on" if lasts else ""), len(points), ends, broken


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--snapin", default=HERE.parents[1] / "build/snapin")
    options = parser.parse_args()
    bad = 0
    for title, old in (("Old results are replaced", OLD), ("A new folder", None)):
        print(f"{title}\n")
        with tempfile.TemporaryDirectory() as folder:
            bad += report(Stand(options.snapin, folder, old), options.every)
    sys.exit(bad > 0)


def report(stand, every):
    """Prints the table of a campaign and returns the number of broken promises."""
    bad = 0
    for call, what, count, ends, broken in campaign(stand, every=every):
        text = "; ".join(f"{number} {end}" for end, number in sorted(ends.items()))
        print(f"| {call} | {what} | {count} | {text} | {len(broken)} |", flush=True)
        for line in broken:
            print("   ", line)
        bad += len(broken)
    ends = power_failures(stand, every=every)
    text = "; ".join(f"{number} {end}" for end, number in sorted(ends.items()))
    print(f"| power fails | | {sum(ends.values())} | {text} | 0 |\n", flush=True)
    return bad


if __name__ == "__main__":
    main()
