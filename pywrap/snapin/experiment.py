"""Runs of whole decks, and two experiments that are described by arguments.

A run starts the program. Its results come through a pipe, so that nothing is written to the disk
unless asked for, other threads continue meanwhile, and an interrupt ends the run.
"""

import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
import warnings
from typing import Any, NamedTuple, Optional

import _snapin
import numpy as np
from numpy.typing import ArrayLike

from .arguments import (
    Array, DeckError, Flags, Path, SnapinError, SnapinWarning, folder_path, vector)
from .deck import Deck, Groups, deck_of, scene
from .results import Result, result_of

# The exit statuses of a run with results, of one with failures and results, and of a wrong deck;
# the beginning of the message of a run without enough memory or disk space.
_DONE, _FAILED, _WRONG_DECK = 0, 1, 2
_NO_ROOM = "not computed: "
# The last piece of a complete stream.
_END = b"complete 0\n"
# Largest difference of the steps of h0 over a step, which is the program's tolerance.
_EQUAL = 1e-6


def run(deck: Deck, out: Optional[Path] = None, *, resume: bool = False,
        quiet: bool = True) -> Result:
    """Run a deck and return its `Result`.

    `deck` is a dictionary of groups, such as {"bodies": {"radius": 1.5e-2, "rigid": True}, ...},
    the text of a deck, or the path of one. Nothing is left on the disk unless `out` names a folder
    for the results; there `resume` continues an interrupted sweep and leaves finished results as
    they are, and files that no run has written are left alone. Without `quiet` progress and
    messages go to standard error.

    A wrong deck raises `DeckError`; results that could not be written, or a calculation without
    results, `SnapinError`; a lack of memory `MemoryError`. Warnings of the program, also of states
    that did not converge, are given as `SnapinWarning`; the result has the states found.
    """
    return _run(deck, out, resume, quiet)


def _run(deck, out=None, resume=False, quiet=True):
    """Run a deck for a function that users call."""
    name, text = deck_of(deck)
    if b"\0" in text:
        raise DeckError(f"{name}: a NUL byte: a deck is plain text")
    if out is None and resume:
        raise ValueError("resume: out must name the folder of the interrupted run")
    place = ["--out", "-"]
    if out is not None:
        folder = os.fspath(folder_path("out", out))
        if "\0" in folder:
            raise ValueError("out: the name of a folder cannot have a NUL")
        if folder == "-":
            raise ValueError("out: '-' is no folder; results are returned, './-' is a folder")
        place += ["--into", folder]
    options = (["--quiet"] if quiet else []) + (["--resume"] if resume else [])
    status, streamed, said = _carry_out([*options, *place, "--name", name, "-"], text, quiet)
    # Results in a folder come through the pipe too: another run may follow there at once.
    result = _result_in(status, streamed, said)
    _tell(result)
    return result


def _result_in(status, streamed, said):
    """Return the result in a stream, if the program has ended with results and the stream is whole.
    """
    if status not in (_DONE, _FAILED) or not streamed.endswith(_END):
        _complain(status, said)
    return result_of(_files_in(streamed), "the program's results")


def _carry_out(arguments, text, quiet):
    """Return the program's exit status, standard output and messages, shown if not quiet."""
    with subprocess.Popen(
            [_program(), *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE) as program:
        try:
            if not quiet:
                return _shown(program, text)
            streamed, said = program.communicate(text)
        except BaseException:
            program.kill()
            raise
    return program.returncode, streamed, said.decode(errors="replace").strip()


def _shown(program, text):
    """Return the same, and show standard error at once."""
    said = []

    def show():
        while piece := program.stderr.read1(4096):
            said.append(piece.decode(errors="replace"))
            sys.stderr.write(said[-1])
            sys.stderr.flush()

    reader = threading.Thread(target=show)
    reader.start()
    # A program that refuses its arguments does not read the deck.
    with contextlib.suppress(BrokenPipeError), program.stdin:
        program.stdin.write(text)
    streamed = program.stdout.read()
    reader.join()
    return program.wait(), streamed, "".join(said).strip()


def _program():
    """Return the path of the program built with this package, or else of one on PATH."""
    # In a build folder, and in pip's folder of commands.
    places = pathlib.Path(_snapin.__file__).parent.parent, sysconfig.get_path("scripts")
    beside = [str(path) for path in (pathlib.Path(place, "snapin") for place in places)
              if path.is_file()]
    found = beside[0] if beside else shutil.which("snapin")
    if not found:
        raise SnapinError("the program snapin is not installed: it is neither beside the package "
                          "nor on PATH")
    return found


def _files_in(streamed):
    """Return the texts of the files in a stream: pieces, each after a line with name and bytes."""
    pieces, start = {}, 0
    while start < len(streamed):
        end = streamed.index(b"\n", start)
        name, _, size = streamed[start:end].decode().rpartition(" ")
        start = end + 1 + int(size)
        pieces.setdefault(name, []).append(streamed[end + 1:start])
    del pieces[_END.split()[0].decode()]
    return {name: b"".join(parts).decode() for name, parts in pieces.items()}


def _complain(status, said):
    """Raise the program's message about a run without results."""
    if status == _WRONG_DECK:
        raise DeckError(said)
    if status < 0:
        raise SnapinError(f"the program was ended by {_name_of(-status)}")
    _, found, reason = said.rpartition(_NO_ROOM)
    if found:
        raise MemoryError(_NO_ROOM + reason)
    raise SnapinError(said or f"the program ended with status {status} and without results")


def _name_of(number):
    """Return the name of a signal."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _tell(result):
    """Give the program's warnings; raise them if the result has no states."""
    said = result.summary.get("warnings", [])
    if not result.converged and said and not any(table.size for table in result.tables.values()):
        raise SnapinError("; ".join(said))
    for warning in said:
        # The warning names the caller of the function that called `_run`.
        warnings.warn(warning, SnapinWarning, stacklevel=4)


# --- Two experiments by arguments


class Point(NamedTuple):
    """A jump, or a fold of the path: h0 [m] and the load [N] just before."""

    h0: float
    load: float


class ForceCurve(NamedTuple):
    """A force curve, SI; arrays have one value for each state that was found.

    `h_centre` is the gap on the axis, `displacement` h_centre - h0, `load` negative under tension,
    `contact_radius` where the gap is that of zero force plus a tenth of the law's length,
    `residual` the largest error of the equations in lengths of the law. `jumps` are in the order
    of the experiment. `max_tension` is positive, also between the given h0, and NaN if there was no
    tension.
    `error_estimate` is the relative error of loads and displacements, `converged` whether all
    states were found. `result` has all that the run reports.
    """

    h0: Array
    h_centre: Array
    displacement: Array
    load: Array
    contact_radius: Array
    residual: Array
    jumps: list[Point]
    max_tension: float
    max_tension_h0: float
    error_estimate: float
    converged: bool
    result: Result


class EquilibriumPath(NamedTuple):
    """The path from far apart to the end, SI; arrays have one value for each state on it.

    Fields are as in `ForceCurve`; `stable` (bool) is stability at controlled h0, and `folds` are
    all points at which h0 turns: the first is snap-in, the last of several snap-off.
    """

    h0: Array
    h_centre: Array
    displacement: Array
    load: Array
    contact_radius: Array
    stable: Flags
    residual: Array
    folds: list[Point]
    max_tension: float
    max_tension_h0: float
    error_estimate: float
    converged: bool
    result: Result


def force_curve(h0: ArrayLike, *, radius: float, stiffness: Optional[float] = None, law: Groups,
                rigid: bool = False, **numerics: Any) -> ForceCurve:
    """Return the `ForceCurve` through the separations `h0` [m], in the order of the experiment.

    They fall in equal steps, as in &loading; then they may rise in equal steps, as in &unloading,
    from the last of them or from one step above. For other experiments use `run`.

    `radius`, `stiffness` and `rigid` are keys of &bodies, `law` the groups of a force law such as
    `lennard_jones` returns, and `numerics` keys of &numerics: accuracy, method, grid and so on.
    """
    h0 = vector("h0", h0)
    groups, repeated = _schedule(h0)
    result = _run(scene(law, radius, stiffness, rigid, **groups, numerics=numerics))
    curve = result.curve
    if not repeated:
        curve = np.delete(curve, np.flatnonzero(curve["branch"] == "unloading_1")[:1])
    jumps = _points(result.summary, ("jump_in", "jump_out"))
    return ForceCurve(**_fields(ForceCurve, curve, result), jumps=jumps)


def equilibrium_path(
        h0_end: float, *, radius: float, stiffness: Optional[float] = None, law: Groups,
        rigid: bool = False, h0_start: Optional[float] = None,
        **numerics: Any) -> EquilibriumPath:
    """Return the `EquilibriumPath` to the contact at `h0_end` [m].

    It has also the unstable states, which no experiment at controlled h0 shows. It begins where
    the bodies hardly deform, or at a larger `h0_start` [m]. The other arguments are as in
    `force_curve`.
    """
    ends = {"h0_start": h0_start, "h0_end": h0_end}
    result = _run(scene(law, radius, stiffness, rigid, equilibrium_path=ends, numerics=numerics))
    fields = _fields(EquilibriumPath, result.curve, result)
    fields["stable"] = fields["stable"] == 1
    folds = _points(result.summary, ("folds",))
    return EquilibriumPath(**fields, folds=folds)


def _schedule(h0):
    """Return the groups &loading and &unloading for these h0, and whether the smallest is there
    twice."""
    if h0.size < 2:
        raise ValueError(f"h0: at least 2 values are needed, not {h0.size}")
    least = int(np.argmin(h0))
    down, up = h0[: least + 1], h0[least + 1 :]
    repeated = up.size > 0 and up[0] == h0[least]
    if not repeated and up.size > 0:
        up = h0[least:]
    groups = {
        "loading": {"h0_start": down[0], "h0_end": down[-1], "h0_step": _step(-np.diff(down))}}
    if up.size > 0:
        groups["unloading"] = {"h0_end": up[-1], "h0_step": _step(np.diff(up))}
    return groups, repeated


def _step(steps):
    """Return the step if all steps are equal."""
    if steps.size == 0 or not (abs(steps - steps.mean()) <= _EQUAL * steps.mean()).all():
        raise ValueError(
            "h0: must fall in equal steps, and may then rise in equal steps; "
            "for other experiments run a deck"
        )
    return steps.mean()


def _fields(kind, curve, result):
    """Return the fields of a kind of result that the curve or the summary has."""
    fields = {name: curve[name].copy() for name in kind._fields if name in curve.dtype.names}
    for name in "max_tension", "max_tension_h0", "error_estimate":
        fields[name] = result.summary.get(name, np.nan)
    return {**fields, "converged": result.converged, "result": result}


def _points(summary, names):
    """Return the points whose h0 and load the summary has under these names."""
    return [
        Point(float(h0), float(load))
        for name in names
        if f"{name}_h0" in summary
        for h0, load in zip(*(np.atleast_1d(summary[f"{name}_{key}"]) for key in ("h0", "load")))
    ]
