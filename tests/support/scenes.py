"""Scenes for tests: decks written from keywords, run by the program, and read back.

Most scenes are in units of the law's length: with R = z0 = E/(1-nu^2) = 1 the parameter sigma of
the paper is gamma itself, h0 is in units of z0, and loads are in units of sigma (gamma R).
"""

import math
import re
from typing import NamedTuple

import numpy as np
import pytest
from snapin import deck_text, results
from snapin.result_text import namelist_groups
from support.processes import HANG, threaded

JKR = 1.5 * math.pi  # Pull-off of JKR theory in units of gamma R.

# Bodies in whose decks lengths are in units of the law's length.
UNIT = {"radius": 1.0, "stiffness": 1.0}
# The force of most decks in SI units.
FORCE = {"law": "lennard_jones", "hamaker": 1e-19, "z0": 0.5e-9}

# --- Decks


def deck(**groups):
    """A deck; a group is a dict of its keys ({}: without any), and None leaves it out.

    `from` is a keyword of Python: write from_.
    """
    return deck_text({
        name: keys and {key.rstrip("_"): value for key, value in keys.items()}
        for name, keys in groups.items()
    })


def lennard_jones(sigma, *, part="full", bodies=UNIT, **groups):
    """A deck in units of z0 and of E/(1-nu^2); loads are then in units of sigma."""
    return deck(
        bodies=bodies,
        force={"law": "lennard_jones", "hamaker": 16 * math.pi * sigma, "z0": 1.0, "part": part},
        **groups)


def exponential(big_lambda, **groups):
    """A deck in units of the decay length; Lambda at h0 = 0 is p0."""
    return deck(
        bodies=UNIT, force={"law": "exponential", "p0": float(big_lambda), "decay_length": 1.0},
        **groups)


def path_of(stiffness, h0_end, accuracy=None, *, radius=1.5e-2, force=FORCE, **groups):
    """A deck with a path in SI units."""
    return deck(**{
        "bodies": {"radius": radius, "stiffness": stiffness}, "force": force,
        "equilibrium_path": {"h0_end": h0_end}, "numerics": {"accuracy": accuracy}, **groups})


def changed(groups, values):
    """Groups with other values of keys: {'group.key': value} or, of a list, 'group.key(number)'."""
    found = {name: dict(keys) for name, keys in groups.items()}
    for name, value in values.items():
        group, key, item = _parts(name)
        if item:
            found[group][key] = [*found[group][key]]
            found[group][key][item - 1] = value
        else:
            found[group][key] = value
    return found


def value_in(groups, name):
    """The value of a key, or of an item of its list."""
    group, key, item = _parts(name)
    return groups[group][key][item - 1] if item else groups[group][key]


def _parts(name):
    group, key, item = re.fullmatch(r"(\w+)\.(\w+)(?:\((\d+)\))?", name).groups()
    return group, key, item and int(item)


def loading(start, end, step):
    return {"h0_start": float(start), "h0_end": float(end), "h0_step": float(step)}


# --- Results


def of_numbers(warnings):
    """The warnings about numbers, without those about the validity of the model."""
    return [text for text in warnings if not text.startswith("beyond the model:")]


class Table(NamedTuple):
    """A CSV file of results: its '#' lines, and its columns by name."""

    comments: list
    columns: dict

    @property
    def names(self):
        return list(self.columns)

    def __getitem__(self, name):
        return self.columns[name]

    def __len__(self):
        return len(self.columns[self.names[0]])

    def rows(self, branch):
        """The columns of one branch (or theory) alone."""
        mine = self.columns[self.names[0]] == branch
        columns = {name: column[mine] for name, column in self.columns.items()}
        return Table(self.comments, columns)


def read_table(path):
    """Read a CSV file of results as the plots do."""
    columns = results.read_table(path.parent, path.name)
    lines = path.read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    # All '#' lines come before the header, and no name occurs twice.
    assert lines[len(comments)].split(",") == list(columns), path
    return Table(comments, columns)


def read_groups(path):
    """The groups of a namelist of results, by the package's reader, which is faster than f90nml. A
    single value is no list, as with f90nml."""
    text = re.sub(r" ! checksum \w+$", "", path.read_text(), flags=re.MULTILINE)
    return {
        name: {key: values[0] if len(values) == 1 else values for key, values in group.items()}
        for name, group in namelist_groups(text).items()}


class Run(NamedTuple):
    status: int
    stderr: str
    folder: object

    @property
    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    @property
    def groups(self):
        return read_groups(self.folder / "summary.nml")

    @property
    def summary(self):
        return self.groups["summary"]

    @property
    def cost(self):
        return self.groups["cost"]

    @property
    def warnings(self):
        """All warnings except those of scales: scenes in law's lengths have R = z0 = E/(1-nu^2)."""
        found = self.summary.get("warnings", [])
        return of_numbers([found] if isinstance(found, str) else found)

    @property
    def curve(self):
        return read_table(self.folder / "curve.csv")

    def table(self, name):
        return read_table(self.folder / name)


def several(value):
    """The values of a namelist key as a list; a single value is read without a list."""
    return list(value) if isinstance(value, list) else [value]


def agreeing(run, scene, accuracies, names, rel=lambda accuracy: accuracy, perhaps=()):
    """The runs of scene(accuracy), which have these numbers of the last run to rel(accuracy);
    those of `perhaps` may be absent in all of them."""
    *found, truth = (run(scene(accuracy)) for accuracy in accuracies)
    assert set(names) <= set(truth.summary)
    for one, accuracy in zip(found, accuracies):
        for name in (*names, *perhaps):
            mine, exact = (np.ravel(each.summary.get(name, [])) for each in (one, truth))
            assert mine == pytest.approx(exact, rel=rel(accuracy)), (accuracy, name)
    return *found, truth


def runner(snapin, folder):
    """run(deck text, status=0, threads=1) -> Run; the same deck is not run twice. None: any status.

    One thread by default: on a busy machine, threads that wait for each other take most time.
    """
    done = {}

    def run(text, *, status=0, threads=1, timeout=HANG):
        key = text, threads
        if key not in done:
            name = f"d{len(done)}"
            (folder / f"{name}.nml").write_text(text)
            result = snapin(f"{name}.nml", cwd=folder, timeout=timeout, env=threaded(threads))
            done[key] = Run(result.returncode, result.stderr, folder / "results" / name)
        assert status in (None, done[key].status), done[key].stderr + text
        return done[key]

    return run
