"""Changes single places of the sources at random, and tells whether a test notices.

    mutations.py [--seed 1] [--count 20] [--first 0] [--room ROOM] [--again]
                 [--folder build-mutations]

The changes of a seed are always the same ones while the sources are: rooms of src/ take turns, and
so do the kinds of change in a room. Work is in a copy of the checkout with its own build:

1. The change is compiled, and nothing else. What does not compile does not count.
2. A few decks are run, up to the first difference. Where no number differs by 1e-9 of itself or of
   its column's largest, the decks do not see the change.
3. Quick tests are run up to the first failure, without those of time and memory: those of the room,
   those that have noticed other changes, and those of the three rooms that use the module most.
   If the decks see the change, the other rooms follow, first those that have noticed most.

A change that fails a test is `noticed`. Otherwise it is `missed` if the decks see it, and `same` if
not. `same` may still break a promise: whoever changes the line decides by reading.

Outcomes are kept in FOLDER, and what has one is not tried again, `missed` and `same` only with
--again. --first leaves out changes of the seed, so that several folders may share them. Prints each
change with its outcome and the score by room. Status 1 if one was missed.
"""

import argparse
import collections
import fcntl
import functools
import itertools
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "pywrap"))
from snapin import results  # noqa: E402
from snapin.result_text import namelist_groups  # noqa: E402
from snapin.command import as_command  # noqa: E402

# Processor seconds of a process, after which a change has made it endless.
ENDLESS = 120
SAME = 1e-9
DECKS = ("tools/verify/decks/*.nml", "inputs/examples/*.nml", "inputs/tutorial/*.nml",
         "inputs/first.nml")
# Processor seconds: decks that take longer are left out.
LONG = 2
# These read the sources themselves, or have nothing to do with them.
BLIND_ROOMS = ("tools", "contact_law")
BLIND = ("tests/model/test_translation.py",)
# Number of tests that have noticed other changes, and are run before those of other rooms.
MOST = 30
# Number of rooms that use a module and whose tests are run even if the decks see no change.
NEAREST = 3

NUMBER = re.compile(r"(?<![\w.])\d+\.\d*(?:e[+-]?\d+)?_wp", re.IGNORECASE)
PAIRS = ((" + ", " - "), ("*", "/"), (" < ", " <= "), (" > ", " >= "), (" == ", " /= "),
         (".and.", ".or."), (".true.", ".false."), ("max(", "min("), (" && ", " || "))
SWAPS = {one: other for pair in PAIRS for one, other in (pair, pair[::-1])}
SWAP = re.compile(r" [-+] | [<>]=? | [=/]= |(?<![*(/])\*(?![*)])|(?<![*(/])/(?![*)=/])"
                  r"|\.(?:and|or|true|false)\.|\bm(?:ax|in)\(| && | \|\| ")
TERM = re.compile(r" [-+] (?:[\d.]+(?:_wp)?\*)?[a-z]\w*(?:%\w+)*(?:\([\w, :]*\))?(?![\w%(*/])")
INDEX = re.compile(r"(?<=\()\d+(?=[,):])|(?<=[,:] )\d+(?=\))")
CONDITION = re.compile(r"^(\s*(?:else )?if \()(.*)(\) .*)$")
USE = re.compile(r"^\s*use (\w+)", re.MULTILINE | re.IGNORECASE)
CALL = re.compile(r"^\s*call \w+(?:%\w+)*\(.*\)$")
# Lines that say what there is and do nothing.
STILL = re.compile(
    r"\s*(?:!|#|/?\*|//|use |import\b|implicit|private|public|module|program|end\b|contains|return$"
    r"|procedure|generic|interface|abstract|type\b|class\b|integer|logical|character|complex"
    r"|(?:(?:pure|elemental|recursive|impure) )*(?:subroutine|function)|include|allocate|format"
    r"|write|static|typedef|struct|real(?!.*::.*=))")


class Change:
    """One changed line of a file of src/: `after` stands where `before` stood."""

    def __init__(self, path, line, before, after, kind):
        self.path, self.line, self.before, self.after, self.kind = path, line, before, after, kind
        self.room = path.split("/")[1]

    def __str__(self):
        return (f"{self.path}:{self.line}: {self.kind}\n    - {self.before.strip()}\n"
                f"    + {self.after.strip()}")


def without_text(line):
    """The line with blanks for what stands in quotes and comments, of the same length."""
    line = re.sub(r"'[^']*'|\"[^\"]*\"", lambda found: "'" + "x" * (len(found[0]) - 2) + "'", line)
    return re.sub(r"(?:!|//| /\*).*", lambda found: " " * len(found[0]), line)


def ways(line, dice):
    """The changes of one line: pairs of a kind and the new line."""
    code = without_text(line)
    if STILL.match(code) or not code.strip():
        return

    def replaced(found, new):
        return line[:found.start()] + new + line[found.end():]

    for found in SWAP.finditer(code):
        yield "other operator", replaced(found, SWAPS[found[0]])
    for found in NUMBER.finditer(code):
        factor = dice.choice((1.01, 1.1, 1.5, 2.0))
        if value := float(found[0][:-3]):
            yield "other constant", replaced(found, f"{value*factor:.6e}_wp")
    for found in TERM.finditer(code):
        yield "term dropped", replaced(found, "")
    for found in INDEX.finditer(code):
        yield "other index", replaced(found, str(int(found[0]) + dice.choice((-1, 1))))
    if found := CONDITION.match(code):
        depth = 0
        for end in range(found.start(2), len(code)):
            depth += (code[end] == "(") - (code[end] == ")")
            if depth < 0:
                inside = line[found.start(2):end]
                yield "condition negated", f"{line[:found.start(2)]}.not. ({inside}){line[end:]}"
                break
    if CALL.match(code):
        yield "call dropped", re.match(r"\s*", line)[0] + "continue"


def candidates(seed):
    """The changes of every file, by room and kind."""
    found = {}
    for path in sorted((ROOT / "src").rglob("*.[fc]*")):
        name = str(path.relative_to(ROOT))
        if path.suffix not in (".f90", ".c") or "minpack" in name or "/mpi/" in name:
            continue
        lines, dice = path.read_text(encoding="utf-8").split("\n"), random.Random(f"{seed} {name}")
        for i, line in enumerate(lines):
            # In C only operators that both languages have.
            for kind, new in ways(line, dice):
                if new != line and (path.suffix == ".f90" or kind == "other operator"):
                    found.setdefault(name.split("/")[1], {}).setdefault(kind, []).append(
                        Change(name, i + 1, line, new, kind))
    return found


def drawn(seed, first, count, room):
    """The first changes of a seed: rooms take turns, and so do the kinds in a room."""
    by_room = candidates(seed)
    rooms = sorted(by_room) if room is None else [room]
    for name in rooms:
        dice = random.Random(f"{seed} {name}")
        kinds = list(by_room[name].values())
        for changes in kinds:
            dice.shuffle(changes)
        dice.shuffle(kinds)
        by_room[name] = [change for turn in itertools.zip_longest(*kinds)
                         for change in turn if change]
    return [by_room[rooms[i % len(rooms)]][i // len(rooms)] for i in range(first, first + count)]


class Copy:
    """A copy of the checkout, with a build and the results of the decks without a change."""

    def __init__(self, folder):
        self.top = folder / "copy"
        self.top.mkdir(parents=True, exist_ok=True)
        self.outcomes = folder / "outcomes.json"
        self._renew()
        if not (self.top / "build" / "build.ninja").exists():
            self._tool("meson", "setup", "-Dpython=enabled", "build")
        assert self.builds(), "the sources do not compile"
        assert self._tool("ninja", "-C", "build").returncode == 0
        usual = {deck: self.run_deck(deck, LONG) for deck in self.decks}
        self.usual = {deck: found for deck, found in usual.items() if found[0] in (0, 1, 2)}

    def _renew(self):
        """Files that differ from those of the checkout; a change that was left behind is undone."""
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others",
                                 "--exclude-standard"], cwd=ROOT, capture_output=True, check=True)
        for name in filter(None, listed.stdout.decode().split("\0")):
            source, target = ROOT / name, self.top / name
            if not source.exists():
                target.unlink(missing_ok=True)
            elif not target.exists() or source.read_bytes() != target.read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                # Not with its time, which may be that of before a change: it is compiled again.
                shutil.copy(source, target)
        if not (self.top / ".venv").exists():
            (self.top / ".venv").symlink_to(ROOT / ".venv")

    def _tool(self, name, *arguments):
        tools = ROOT / ".venv" / "bin"
        return subprocess.run(
            [tools / name, *arguments], cwd=self.top, capture_output=True, text=True, check=False,
            env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"})

    def builds(self):
        """Whether program and wrapper can be built."""
        wrapper = next((self.top / "build" / "pywrap").glob("_snapin.*.so"), None)
        targets = ["snapin", *([f"pywrap/{wrapper.name}"] if wrapper else [])]
        return self._tool("ninja", "-C", "build", "-j", "1", *targets).returncode == 0

    @functools.cached_property
    def decks(self):
        return sorted(path for pattern in DECKS for path in self.top.glob(pattern))

    def run_deck(self, deck, seconds=ENDLESS):
        """Status and results of a deck, read into numbers and words."""
        out = self.top / "results-of-decks"
        shutil.rmtree(out, ignore_errors=True)
        done = subprocess.run(
            _limited(seconds, self.top / "build/snapin", "--quiet", "--into", out, deck),
            cwd=deck.parent, capture_output=True, env={**os.environ, "OMP_NUM_THREADS": "1"},
            check=False)
        return done.returncode, _read(out)

    def first_difference(self):
        """The first deck whose results are others than without the change; None if none has."""
        return next((f"{deck.stem}: {what}" for deck, found in self.usual.items()
                     if (what := difference(found, self.run_deck(deck)))), None)

    def first_failure(self, tests):
        """The first of these tests that fails, or None."""
        done = subprocess.run(
            _limited(ENDLESS, ROOT / ".venv/bin/python", "-m", "pytest", "-q", "-x", "-n", "0",
                     "-p", "no:cacheprovider", "-m", "not slow and not long and not alone", *tests),
            cwd=self.top, capture_output=True, text=True, errors="replace", check=False)
        if done.returncode in (0, 5):
            return None
        found = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", done.stdout, re.MULTILINE)
        return found[1] if found else f"pytest ends with status {done.returncode}"

    @functools.cached_property
    def users(self):
        """{module: those that use it}, each as (room, name); the wrapper's room is `wrapper`."""
        found = {}
        for path in [*self.top.glob("src/**/*.f90"), *self.top.glob("pywrap/*.f90")]:
            top, room = path.relative_to(self.top).parts[:2]
            user = (room if top == "src" else "wrapper", path.stem)
            for name in USE.findall(path.read_text(encoding="utf-8")):
                found.setdefault(name.lower(), set()).add(user)
        return found

    def rooms_that_use(self, change):
        """Other rooms that use the module of the change, also through modules of its own room;
        first those with most modules that do so."""
        reached, ahead = set(), {(change.room, pathlib.Path(change.path).stem)}
        while ahead:
            reached |= ahead
            ahead = {user for room, name in ahead if room == change.room
                     for user in self.users.get(name, ())} - reached
        rooms = collections.Counter(room for room, _ in reached if room != change.room)
        return sorted(rooms, key=lambda name: (-rooms[name], name))

    def groups_of_tests(self, change, known, seen):
        """Lists of tests in the order in which they are run; seen: whether the decks differ."""
        room = change.room
        noticed = [found["test"].split("[")[0] for found in known.values()
                   if found["outcome"] == "noticed" and "::" in found["test"]]
        rooms = collections.Counter(test.split("/")[1] for test in noticed)
        yield [f"tests/{room}"] if (self.top / "tests" / room).exists() else []
        yield [test for test, _ in collections.Counter(noticed).most_common(MOST)]
        others = {path.name for path in (self.top / "tests").iterdir()
                  if any(path.glob("test_*.py"))} - {room, *BLIND_ROOMS}
        near = [name for name in self.rooms_that_use(change) if name in others][:NEAREST]
        far = sorted(others - {*near}, key=lambda name: (-rooms[name], name))
        for other in near + far if seen else near:
            yield [f"tests/{other}", *(f"--ignore={path}" for path in BLIND)]

    def outcome(self, change, known):
        path = self.top / change.path
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        assert lines[change.line - 1] == change.before
        lines[change.line - 1] = change.after
        path.write_text("\n".join(lines), encoding="utf-8")
        try:
            if not self.builds():
                return {"outcome": "no program"}
            seen = self.first_difference()
            failed = None
            for tests in self.groups_of_tests(change, known, seen):
                if tests and failed is None:
                    failed = self.first_failure(tests)
            return {"outcome": "noticed" if failed else "missed" if seen else "same",
                    "seen in": seen, "test": failed}
        finally:
            path.write_text(text, encoding="utf-8")


def _limited(seconds, *command):
    """The command, ended after so many processor seconds, and so is each process that it starts."""
    return ["sh", "-c", f'ulimit -t {seconds}; exec "$@"', "sh", *command]


def _read(folder):
    """{file: {column: cells}} of results that can be read, otherwise their bytes."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.exists() else ():
        try:
            if path.suffix == ".csv" and path.name != "costs.csv":
                found[path.name] = results.read_table(path.parent, path.name)
            elif path.name == "summary.nml":
                # Costs and the deck follow, with comments.
                text = path.read_text(encoding="utf-8").partition("\n&cost\n")[0]
                for group, keys in namelist_groups(text).items():
                    found[f"summary {group}"] = {key: np.array(value)
                                                 for key, value in keys.items()}
        except Exception:  # A changed program may write anything. # noqa: BLE001
            found[path.name] = path.read_bytes()
    return found


def difference(one, other):
    """The first file whose numbers differ; None if there is none."""
    (status, files), (other_status, other_files) = one, other
    if status != other_status:
        return "status"
    if files.keys() != other_files.keys():
        return "files"
    return next((name for name, columns in files.items()
                 if not _same(columns, other_files[name])), None)


def _same(one, other):
    if isinstance(one, bytes) or isinstance(other, bytes):
        return one == other
    if one.keys() != other.keys():
        return False
    for key, cells in one.items():
        mine, theirs = np.asarray(cells), np.asarray(other[key])
        if mine.shape != theirs.shape or mine.dtype.kind != theirs.dtype.kind:
            return False
        # An error estimate is known to a few digits.
        near = 1e-3 if "error" in key else SAME
        if mine.dtype.kind == "f" and mine.size:
            size = np.abs(mine[np.isfinite(mine)]).max(initial=0)
            if not np.allclose(mine, theirs, rtol=near, atol=near*size, equal_nan=True):
                return False
        elif mine.dtype.kind != "f" and not (mine == theirs).all():
            return False
    return True


def score(changes, known):
    """Rows of a table by room, and the last for all."""
    kinds = "noticed", "missed", "same", "no program"
    rooms = {}
    for change in changes:
        found = known.get(str(change))
        if found:
            counts = rooms.setdefault(change.room, dict.fromkeys(kinds, 0))
            counts[found["outcome"]] += 1
    total = {kind: sum(counts[kind] for counts in rooms.values()) for kind in kinds}
    print("| room | noticed | missed | same | no program |\n|---|---|---|---|---|")
    for name, counts in [*sorted(rooms.items()), ("all", total)]:
        print(f"| {name} |", " | ".join(str(counts[kind]) for kind in kinds), "|")
    judged = total["noticed"] + total["missed"]
    print(f"{total['noticed']} of {judged} changes that alter results or fail a test are noticed")
    return total["missed"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--room")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--list", action="store_true", help="show the changes and try none")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build-mutations")
    chosen = parser.parse_args()
    changes = drawn(chosen.seed, chosen.first, chosen.count, chosen.room)
    if chosen.list:
        print(*changes, sep="\n")
        return 0
    chosen.folder.mkdir(parents=True, exist_ok=True)
    lock = (chosen.folder / "lock").open("w")
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    copy = Copy(chosen.folder.resolve())
    known = json.loads(copy.outcomes.read_text()) if copy.outcomes.exists() else {}
    for change in changes:
        before = known.get(str(change), {}).get("outcome")
        if before is None or (chosen.again and before in ("missed", "same")):
            found = known[str(change)] = copy.outcome(change, known)
            copy.outcomes.write_text(json.dumps(known, indent=1))
            print(change, found["outcome"], found.get("seen in"), found.get("test"), sep="\n    ",
                  flush=True)
    return 1 if score(changes, known) else 0


if __name__ == "__main__":
    sys.exit(as_command(main)())
